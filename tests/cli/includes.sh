# Includes go one way: macro/, rve/ and process/ stand on src/ and never on each other, but that process/ knows the public
# header of the macroscale; src/ on none; src/app may know all.
set -u
cd "$2" || exit 1
failures=0

# refuse FILES PATTERN WHY: no #include of the files may match the pattern
refuse() {
  # shellcheck disable=SC2086
  found=$(grep -nE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($2)" $1)
  [ -z "$found" ] && return
  printf 'includes: %s:\n%s\n' "$3" "$found" >&2
  failures=$((failures + 1))
}

# headers FOLDER: its headers as alternatives of a pattern, with or without the folder's name before them
headers() {
  (cd "$1" && ls -- *.h) | sed 's/\./\\./' | paste -sd'|' | sed "s,.*,([./]*$1/)?(&)[\">],"
}

for folder in src rve macro process src/app; do
  [ -n "$(ls "$folder"/*.h)" ] || { echo "includes: no headers in $folder" >&2; exit 1; }
done
public='lamella/(lamella|rve|macro|process|cache)\.h'
refuse "src/*.[ch]" "$(headers rve)|$(headers macro)|$(headers process)|$(headers src/app)" "src/ includes what stands on it"
refuse "src/*.[ch]" "lamella/(lamella|rve|macro|process)\.h" "src/ knows a solver"
refuse "rve/*.[ch]" "$(headers macro)|$(headers process)|$(headers src/app)" "rve/ includes another part"
refuse "rve/*.[ch]" "lamella/(lamella|macro|process)\.h" "rve/ knows the macroscale"
refuse "macro/*.[ch]" "$(headers rve)|$(headers process)|$(headers src/app)" "macro/ includes another part"
refuse "macro/*.[ch]" "lamella/(lamella|rve|process)\.h" "macro/ knows the RVE solver"
refuse "process/*.[ch]" "$(headers rve)|$(headers macro)|$(headers src/app)" "process/ includes another part"
refuse "process/*.[ch]" "lamella/(lamella|rve)\.h" "process/ knows the RVE solver"
refuse "include/lamella/scene.h include/lamella/response.h include/lamella/database.h" "$public" \
  "a public header of the base knows a solver"
exit $((failures > 0))
