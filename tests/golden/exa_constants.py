"""The constants of EXA as one file beside the page: `python3 exa_constants.py` compares docs/exa_constants.txt with the
tables of the program and with the SHA-256 on docs/exa.md; `--write` makes the file."""

import hashlib
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "docs" / "exa_constants.txt"
TABLES = [("sign model 0", "signs/sign_weights.inc", 0), ("sign model 1", "signs/sign_weights.inc", 1),
          ("sign model 2", "signs/sign_weights_wide.inc", 0), ("offset model 0", "offsets/offset_weights.inc", 0),
          ("offset model 1", "offsets/offset_weights.inc", 1)]


def text():
    out = ["# Constants of EXA, versions 3 to 7 (exa.md): a line with a table's name and how many numbers follow, then those.\n"]
    for name, source, which in TABLES:
        code = (ROOT / "core" / "exa" / source).read_text()
        numbers = re.findall(r"-?\d+", re.findall(r"\[\] = \{(.*?)\};", code, re.S)[which])
        out.append(f"{name} {len(numbers)}\n")
        out += [" ".join(numbers[i:i + 32]) + "\n" for i in range(0, len(numbers), 32)]
    kept = FILE.read_text()  # made by the rule of docs/manifold.md: labels_test.cpp compares
    return "".join(out) + kept[kept.index("label chords "):]


def main():
    if "--write" in sys.argv:
        FILE.write_text(text())
    found = FILE.read_text()
    digest = hashlib.sha256(found.encode()).hexdigest()
    if found != text():
        sys.exit("docs/exa_constants.txt is not what the program's tables give: exa_constants.py --write")
    if digest not in (ROOT / "docs" / "exa.md").read_text():
        sys.exit(f"docs/exa.md does not have the SHA-256 of the constants, {digest}")
    print("good")


main()
