# slow: The documents: what README.md and docs/tutorial.md show is what the program prints, the reference names every option of
# every command, and every link and every path of a document that a file cites exists.
. "$(dirname "$0")/common.sh"
/usr/bin/python3 "$source/tests/cli/docs.py" "$lamella" "$source"
