#!/usr/bin/env bash
# lamella completion: bash completes commands, options, files and the words that a value may be; zsh reads its script.
. "$(dirname "$0")/common.sh"

"$lamella" completion bash >lamella.bash || fail "no script for bash"
. ./lamella.bash
complete -p lamella >/dev/null || fail "bash completes no lamella"
touch scene.yaml other.txt db.h5 picture.png
mkdir folder.d

# completes WANTED WORD...: what completes the last word; "=" is a word of its own, as in COMP_WORDBREAKS
completes() {
  local wanted=$1
  COMP_WORDS=(lamella "${@:2}")
  COMP_CWORD=$(($# - 1))
  _lamella
  local found=${COMPREPLY[*]}
  [ "$found" = "$wanted" ] || fail "'$found' instead of '$wanted' completes: lamella ${*:2}"
}

completes check ch
completes "map merge manual" m
completes --version --v
completes "" nonsense --
completes --certify fe2 --c
completes "--response --resume" fe2 scene.yaml --res
completes "direct cache database" fe2 --response ""
completes "direct database" process --response = d
completes cache process --response=x --response = c # `=` alone is the word before
completes "scene.yaml folder.d" check ""
completes "db.h5 folder.d" merge db.h5 ""
completes db.h5 rve -o d
completes db.h5 rve --output = d
completes picture.png plot -o p
completes folder.d tradeoff --output f
completes mesh,strategy,sharpness tradeoff --only mesh,strategy,sh
completes "wall_tension wall_tension_max wall_tension_ratio_max" plot db.h5 --field wall_tension
completes kinked_fraction plot db.h5 --field ki # a member of records, for maps
completes "merge" help me
completes "bash zsh" completion ""
completes "" verify --samples ""
completes "" rve -- ""
[ "$("$lamella" completion bash)" = "$(cat lamella.bash)" ] || fail "two scripts differ"

# every command and every option
for command in $("$lamella" help | sed -n 's/^  \([a-z0-9]*\) .*/\1/p'); do
  for option in $("$lamella" help "$command" | sed -n 's/^ *\(-[a-zA-Z], \)\{0,1\}\(--[a-z-]*\).*/\2/p'); do
    COMP_WORDS=(lamella "$command" "$option") COMP_CWORD=2
    _lamella
    [[ " ${COMPREPLY[*]} " == *" $option "* ]] || fail "$command $option is not completed"
  done
done

expect 1 -e "give bash or zsh" "$lamella" completion tcsh
expect 0 -o '^#compdef lamella$' "$lamella" completion zsh
if command -v zsh >/dev/null; then zsh -n out.txt || fail "zsh does not read its script"; fi
