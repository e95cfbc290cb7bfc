"""The source of the token, and where people find it: never on a command line, which others can read.

Files with a token belong to one user and can be read by no other.
"""

from __future__ import annotations

import os
import secrets
import stat
import tempfile
from collections.abc import Mapping
from pathlib import Path

VARIABLE = "PVFIBLETS_TOKEN"
LONGEST = 4096  # bytes of a file with only a token


def chosen_token(choice: str, file: str | None = None, environment: Mapping[str, str] | None = None) -> str | None:
    """Return the token to ask for, or ``None`` for none."""
    if choice not in ("auto", "none"):
        raise ValueError(
            "--token takes auto or none: other users of this machine can read command lines, so a token of your own "
            f"comes from --token-file FILE or from the environment variable {VARIABLE}"
        )
    if choice == "none":
        if file is not None:
            raise ValueError(f"--token none and --token-file {file} contradict each other; leave one of them out")
        return None
    if file is not None:
        return _from_file(Path(file))
    return (environment or {}).get(VARIABLE, "").strip() or new_token()


def new_token() -> str:
    """Return a token that cannot be guessed."""
    return secrets.token_urlsafe(24)


def _from_file(path: Path) -> str:
    try:
        status = path.stat()
    except FileNotFoundError:
        token = new_token()
        write(path, token)
        return token
    if not stat.S_ISREG(status.st_mode):
        raise ValueError(f"--token-file {path}: not a file")
    if os.name == "posix" and status.st_mode & 0o077:
        raise ValueError(f"--token-file {path}: others can read or change it; chmod 600 {path}")
    if status.st_size > LONGEST:
        raise ValueError(f"--token-file {path}: {status.st_size} bytes, expected one line with a token")
    token = path.read_text(encoding="utf-8").strip()
    if not token or not token.isprintable() or " " in token:
        raise ValueError(f"--token-file {path}: expected one line with a token, without spaces")
    return token


def write(path: Path, token: str) -> None:
    """Write a token into a new file that only this user can read."""
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(token + "\n")


def keep(token: str, environment: Mapping[str, str] | None = None) -> Path:
    """Write a token where only this user finds it, and return the file; it is alone in its folder."""
    runtime = (environment or {}).get("XDG_RUNTIME_DIR", "")
    folder = tempfile.mkdtemp(prefix="pvfiblets-token-", dir=runtime if os.access(runtime, os.W_OK) else None)
    path = Path(folder) / "token"
    write(path, token)
    return path


def forget(path: Path) -> None:
    """Take away what :func:`keep` made."""
    path.unlink(missing_ok=True)
    path.parent.rmdir()
