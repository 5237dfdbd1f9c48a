#!/usr/bin/env bash
# slow: a fixed choice of states of the map of extremes: none is not finite, beyond its time or a crash
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$folder/map.jsonl" --ids "$(dirname "$0")/fixed.txt" --jobs 2
