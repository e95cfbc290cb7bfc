"""Build the script of pages: `make client`. Needs node and npm, which nothing else of this repository does.

`client/src` and the shaders that scripts/page_shaders.py takes from the engine become ``pvfiblets/page/page.js``, which
is part of the repository, so that neither users nor tests need node. Its first line names its sources: a test
compares that.
"""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from page_shaders import everything

ROOT = Path(__file__).resolve().parents[1]
CLIENT = ROOT / "client"
BUNDLE = ROOT / "pvfiblets" / "page" / "page.js"
LARGEST = 150_000


def engine_text() -> str:
    """Return what the client takes from the package, as a file of JSON."""
    return json.dumps(everything(), sort_keys=True, indent=1) + "\n"


def first_line() -> str:
    """Return the first line of the script that today's sources make."""
    digest = hashlib.sha256(engine_text().encode())
    for path in [*sorted((CLIENT / "src").rglob("*.ts")), CLIENT / "package.json", CLIENT / "package-lock.json"]:
        digest.update(path.relative_to(CLIENT).as_posix().encode() + b"\0" + path.read_bytes())
    return f"// Built by `make client` of sources {digest.hexdigest()[:16]}"


def build() -> str:
    """Return the script that today's sources make."""
    (CLIENT / "build").mkdir(exist_ok=True)
    (CLIENT / "build" / "engine.json").write_text(engine_text(), encoding="utf-8")
    for command in (["npm", "ci", "--no-audit", "--no-fund"], ["npm", "run", "check"], ["npm", "run", "build"]):
        if command[1] == "ci" and (CLIENT / "node_modules" / ".package-lock.json").is_file():
            continue
        subprocess.run(command, cwd=CLIENT, check=True, stdout=subprocess.DEVNULL)
    return f"{first_line()}\n{(CLIENT / 'build' / 'page.js').read_text(encoding='utf-8')}"


def main() -> None:
    """Write the script."""
    text = build()
    if len(text.encode()) > LARGEST:
        raise SystemExit(f"{BUNDLE} would have {len(text.encode())} bytes; at most {LARGEST} are allowed")
    BUNDLE.write_text(text, encoding="utf-8")
    print(f"{BUNDLE.relative_to(ROOT)}: {len(text.encode())} bytes")


if __name__ == "__main__":
    main()
