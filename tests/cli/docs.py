"""Checks of the documents, for docs.sh: python3 docs.py LAMELLA SOURCE_DIR [DOCUMENT], in an empty folder; of DOCUMENT the
examples alone. Prints what is wrong."""
import json
import os
import re
import subprocess
import sys
import unicodedata
from pathlib import Path

lamella, source = Path(sys.argv[1]), Path(sys.argv[2])
reference = (source / "docs/reference/commands.md").read_text().split("\n## ")
sections = {part.split("\n")[0]: part for part in reference[1:]}  # by command
failures = []


def fail(where, what):
    failures.append(f"{where}: {what}")


# Links: the file is there, and so is the anchor by GitHub's rule.
def anchors(text):
    found = {}
    for title in re.findall(r"^#+ +(.*?) *$", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M), re.M):
        title = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", title).lower()
        kept = "".join(c for c in title if c in "- " or unicodedata.category(c)[0] in "LM" or unicodedata.category(c) in ("Nd", "Pc"))
        name = kept.replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name + (f"-{n}" if n else "") for name, last in found.items() for n in range(last + 1)}


def check_links(document):
    text = document.read_text()
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"^(    |```).*", "", text, flags=re.M)):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        path = (document.parent / name).resolve() if name else document
        if not path.exists():
            fail(document, f"link to {target}: no such file")
        elif anchor and anchor not in anchors(path.read_text()):
            fail(document, f"link to {target}: no such heading")
    for scene in re.findall(r"\btests/scenes/[\w./-]+\.yaml", text):
        if not (source / scene).exists():
            fail(document, f"names {scene}, which is not there")


def check_citations():
    for folder in ("include", "src", "rve", "macro", "process", "tests", "examples"):
        for file in (source / folder).rglob("*"):
            if file.suffix in (".c", ".h", ".sh", ".py", ".yaml", ".txt"):
                for path in re.findall(r"\bdocs/[\w./-]+\.(?:md|sbatch)\b", file.read_text(errors="replace")):
                    if not (source / path).exists():
                        fail(file, f"cites {path}, which is not there")


# lamella.h: its comment names every header that it includes.
def check_reading_list():
    comment, code = (source / "include/lamella/lamella.h").read_text().split("*/", 1)
    for header in re.findall(r"#include [<\"](?:lamella/)?(\w+\.h)", code):
        if header not in comment:
            fail("lamella.h", f"its reading list lacks {header}")


# Options: the synopsis of each command is that of --help, and its section has every option.
def check_options():
    synopses = " ".join(reference[0].split())
    commands = re.findall(r"^  (\w+) +\w", run(f"{lamella} --help"), re.M)
    if len(commands) < 12:
        fail("lamella --help", f"lists {len(commands)} commands")
    for command in commands:
        text = run(f"{lamella} {command} --help")
        usage = re.match(r"Usage: (.*?\n)(?! )", text, re.S).group(1)
        if " ".join(usage.split()) not in synopses:
            fail("docs/reference/commands.md", f"has not the synopsis {usage}")
        section = sections.get(command, "") + sections["Options, output and exit status"]
        for short, option in re.findall(r"^ +(?:(-\w), +)?(--[\w-]+)", text, re.M):
            if not re.search(rf"(?<![\w-])({option}{short and '|' + short})\b", section):
                fail("docs/reference/commands.md", f"{command}: {option} is missing")


# JSON: the section of a command names the members of what it prints; map prints members of rve, too.
def members(value):
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
        yield from members(item)
    yield from value if isinstance(value, dict) else []


def check_members():
    for command in ("rve tests/scenes/shear-contact.yaml --tangent --second-mesh", "rve tests/scenes/uniaxial.yaml",
                    "rve tests/scenes/shear-dry.yaml --onset", "rve tests/scenes/failure.yaml --failure",
                    "check tests/scenes/tissue-block.yaml", "check tests/scenes/uneven-cells.yaml",
                    "check tests/scenes/hexagons-dry.yaml", "check tests/scenes/ripening.yaml",
                    "query tissue.h5 -F '1.05 0.02 0 1.03' --tangent", "verify tissue.h5 --samples 2",
                    "map tests/scenes/map-shear-turgor.yaml -o members.h5"):
        name = command.split()[0]
        text = sections[name] + (sections["rve"] if name in ("query", "verify", "map") else "")
        objects = [json.loads(line) for line in run(f"build/lamella {command} --json 2>err.txt").split("\n") if line]
        for member in sorted(set(members(objects))):
            if not re.search(rf'[`"]{re.escape(member)}[`"]', text):
                fail("docs/reference/commands.md", f"{command}: the member {member} is missing")


# Examples: commands in blocks begin with "$ "; what follows is what they print. A line "..." stands for any number of lines.
def run(command):
    done = subprocess.run(["bash", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        fail(command, f"exit status {done.returncode}: {done.stdout}")
    return done.stdout


MACHINE = r"\d[-+.\de]* (?:us|ms|s|min|h|MB|% of the time)\b|(?<=nodes per s).*|(?<=created).*|(?<=host).*"


def masked(lines):
    """Times and memory as '#', rounding errors as 0, in the columns time, seconds, solving and residuals of tables, too."""
    result, ends = [], []
    for line in lines:
        if re.match(r"(state|step) +\w", line):
            ends = [word.end() for word in re.finditer(r"\b(?:time|seconds|solving)\b", line)]
            residuals = line.find("residuals")
        words = []
        for word in re.finditer(r"\S+", re.sub(MACHINE, lambda m: "#".rjust(len(m[0])), line)):
            text = word[0]
            if re.match(r" *\d", line) and ends and (word.end() in ends or 0 < residuals <= word.start()):
                text = "#"
            if re.fullmatch(r"-?[\d.]+e-(1[2-9]|[2-9]\d)", text) or re.fullmatch(r"-?0?\.?0+(e\+00)?", text):
                text = "0"
            words.append(text)
        result.append(words)
    return result


def alike(shown, printed):
    """The same word, or numbers that are no whole ones and differ by at most one in the last digit."""
    if shown == printed:
        return True
    number = r"(\D*)(-?\d*)\.(\d+)(e[-+]\d+)?(\D*)"
    one, other = re.fullmatch(number, shown), re.fullmatch(number, printed)
    if not one or not other or one.group(1, 5) != other.group(1, 5):
        return False
    value = [float(f"{m[2]}.{m[3]}{m[4] or ''}") for m in (one, other)]
    return abs(value[0] - value[1]) <= 1.001 * 10.0 ** (int((one[4] or "e0")[1:]) - len(one[3]))


def first_difference(shown, printed):
    """None, or the first line of `shown` that does not follow in `printed`."""
    place, jump, found = 0, False, masked(printed)
    for line, words in zip(shown, masked(shown)):
        if line.strip() == "...":
            jump = True
            continue
        there = [len(words) == len(other) and all(map(alike, words, other)) for other in found[place:]]
        at = there.index(True) if jump and True in there else 0
        if not there or not there[at]:
            return line
        place, jump = place + at + 1, False
    return None if jump or place == len(printed) else f"(end), but more is printed: {printed[place]}"


def check_examples(document):
    text = (source / document).read_text()
    blocks = re.findall(r"(?:^(?:    .*)?\n)+|^```\w*\n(?s:.*?)^```", text, re.M)
    lines = [line for block in blocks for line in [x.removeprefix("    ") for x in block.split("\n") if not x.startswith("```")] + [None]]
    count, line = 0, 0
    while line < len(lines):
        command = lines[line]
        line += 1
        if command and re.match(r"(build/)?lamella |mpirun ", command):
            fail(document, f"a command without '$ ': {command}")
        if not command or not command.startswith("$ "):
            continue
        shown = []
        while line < len(lines) and lines[line] is not None and not lines[line].startswith("$ "):
            shown.append(lines[line].rstrip())
            line += 1
        while shown and not shown[-1]:
            shown.pop()
        printed = run(command[2:]).rstrip("\n").split("\n")
        count += 1
        difference = first_difference(shown, printed) if shown else None
        if difference is not None:
            fail(document, f"{command}\n  shows    {difference}\n  but prints\n" + "\n".join("    " + x for x in printed))
    if count < 5:
        fail(document, f"has {count} commands")


documents = sys.argv[3:]
if not documents:
    for document in [*source.glob("*.md"), *(source / "docs").rglob("*.md")]:
        check_links(document)
    check_citations()
    check_reading_list()
    check_options()
for document in documents or ("README.md", "docs/tutorial.md"):
    folder = Path(document).stem
    os.makedirs(f"{folder}/build")
    os.symlink(lamella, f"{folder}/build/lamella")
    for name in ("tests", "examples"):
        os.symlink(source / name, f"{folder}/{name}")
    os.chdir(folder)
    check_examples(document)
    if document == "README.md":
        check_members()  # it has built tissue.h5
    os.chdir("..")
print("\n".join(failures), end="\n" if failures else "")
sys.exit(1 if failures else 0)
