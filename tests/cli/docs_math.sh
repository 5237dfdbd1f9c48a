# The equations of the documents: delimiters, braces and environments balance, macros are known, nothing is in them that
# Markdown would take for its own; the source files and programs that documents name exist, and so do the titles that
# sources cite.
. "$(dirname "$0")/common.sh"
/usr/bin/python3 - "$source" <<'PYTHON'
import re, sys
from pathlib import Path

source, failures, equations = Path(sys.argv[1]), [], 0
known = set("""Big Delta Gamma Phi Pi Psi Sigma alpha ast bar begin beta cases cdot chi cos cot cr delta det dots end epsilon eta exp frac
gamma ge gg in infty int kappa lambda langle lbrace lceil le left leftarrow lfloor ll ln lt mathcal mathit mathop mathrm max min mu nabla omega otimes
partial phi pi pm propto psi qquad quad rangle rbrace rceil rfloor right sigma sim sin sqrt sum tau text theta times to varepsilon varphi vartheta
xi""".split())

def check(where, math, inline):
    def fail(what):
        failures.append(f"{where}: {what}: {math[:80]}")
    depth = 0
    for brace in re.findall(r"(?<!\\)[{}]", math):
        depth += 1 if brace == "{" else -1
        if depth < 0:
            break
    if depth:
        fail("braces")
    if len(re.findall(r"\\left\b", math)) != len(re.findall(r"\\right\b", math)):
        fail("left and right")
    if re.findall(r"\\begin\{(\w+)\}", math) != re.findall(r"\\end\{(\w+)\}", math)[::-1] and sorted(
            re.findall(r"\\begin\{(\w+)\}", math)) != sorted(re.findall(r"\\end\{(\w+)\}", math)):
        fail("environments")
    if re.search(r"\\[^a-zA-Z]", math):
        fail("backslash before punctuation, which Markdown removes")
    if "](" in math or re.search(r"[*<`$]", math):
        fail("a character that Markdown takes for its own")
    for macro in set(re.findall(r"\\([a-zA-Z]+)", math)) - known:
        fail(f"unknown macro {macro}")
    if inline and (math != math.strip() or "\n\n" in math):
        fail("blank at the end")

for document in [*source.glob("*.md"), *(source / "docs").rglob("*.md")]:
    text = re.sub(r"^    .*$", "", document.read_text(), flags=re.M)
    text = re.sub(r"`[^`\n]*`", "", text)
    for block in re.finditer(r"^\$\$\n(.*?)\n\$\$$", text, re.S | re.M):
        equations += 1
        check(document, block[1], False)
        if text[: block.start()][-2:] != "\n\n" or text[block.end() :][:2] not in ("\n\n", "\n"):
            failures.append(f"{document}: no blank line around {block[1][:60]}")
        if re.search(r"^\s*([-+=#>]|\d+\.|$)", block[1], re.M):
            failures.append(f"{document}: a line of an equation begins like Markdown: {block[1][:60]}")
    text = re.sub(r"^\$\$\n.*?\n\$\$$", "", text, flags=re.S | re.M)
    for paragraph in re.split(r"\n\s*\n|\n(?=[|*] ?)|\n(?=\d\. )", text):
        if paragraph.count("$") % 2:
            failures.append(f"{document}: odd number of dollars: {paragraph[:80]}")
            continue
        parts = paragraph.split("$")
        for i, math in enumerate(parts):
            if i % 2:
                equations += 1
                check(document, math, True)
                if "|" in math and paragraph.startswith("|"):
                    failures.append(f"{document}: a bar in a table: {math}")
                if re.search(r"\w\Z", parts[i - 1]) or re.match(r"\w", parts[i + 1]):
                    failures.append(f"{document}: a letter touches the dollar of {math}")

rooms = ("include", "src", "rve", "macro", "process", "tests", "examples")
programs = {file.stem for file in (source / "tests").rglob("*") if file.suffix in (".c", ".sh", ".py")}
for document in (source / "docs").rglob("*.md"):
    text = document.read_text()
    for path in re.findall(r"`([\w/]+[\w*]+\.[ch])`", text):
        if not any(list(source.glob(f"{room}/**/{path}") if "/" not in path else source.glob(path)) for room in rooms):
            failures.append(f"{document}: {path} is not there")
    for program in re.findall(r"\b((?:bench|test|fuzz)_\w+)\b(?!\*)", text):
        if not any(name.startswith(program) for name in programs):
            failures.append(f"{document}: {program} is not there")

citations = 0
for folder in rooms:
    for file in (source / folder).rglob("*.[ch]"):
        text = re.sub(r"\s*\n[ *]*", " ", file.read_text())
        for path, title in re.findall(r"\b(docs/(?:theory|results)/[\w-]+\.md)[,;] +\"?([A-Z][^.;):\"]*)", text):
            citations += 1
            titles = re.findall(r"^#+ +(.*?) *$", (source / path).read_text(), re.M)
            if not any(title.startswith(known_title) for known_title in titles):
                failures.append(f"{file}: {path} has no section {title}")

if citations < 10:
    failures.append(f"only {citations} citations of titles found")
if equations < 500:
    failures.append(f"only {equations} equations found")
print("\n".join(failures), end="\n" if failures else "")
sys.exit(1 if failures else 0)
PYTHON
