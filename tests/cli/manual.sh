#!/usr/bin/env bash
# lamella manual: a page that man reads without a warning, with every option; its exit statuses are those of the documents.
. "$(dirname "$0")/common.sh"

expect 0 -o '^\.TH LAMELLA 1 ' "$lamella" manual
mv out.txt lamella.1
if command -v groff >/dev/null; then
  groff -man -Tutf8 -ww -z lamella.1 2>warnings.txt
  [ ! -s warnings.txt ] || fail "groff: $(cat warnings.txt)"
fi
tr -d '\\' <lamella.1 >plain.txt
for command in $("$lamella" help | sed -n 's/^  \([a-z0-9]*\) .*/\1/p'); do
  sed -n "/^\.SS $command\$/,/^\.S/p" plain.txt >section.txt
  has section.txt "^$command\( \|\$\)"
  for option in $("$lamella" help "$command" | sed -n 's/^ *\(-[a-zA-Z], \)\{0,1\}--\([a-z-]*\).*/\2/p'); do
    [ "$option" = help ] || has section.txt "fB--fRfB${option}fR"
  done
done
while read -r _ status; do
  read -r meaning
  has "$source/docs/reference/commands.md" "^| $status | $meaning |\$"
done < <(sed '1,/^\.SH EXIT STATUS/d' plain.txt | grep -v '^\.TP')
