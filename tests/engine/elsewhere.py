"""Work for a process of its own, whose OpenGL has nothing newer: there storage buffers and compute do not compile."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PREPARE = """
import importlib.util, pickle, sys
import moderngl
from pathlib import Path
root, version, *arguments = sys.argv[1:]
for name in ("tests", "tests.engine"):
    spec = importlib.util.spec_from_loader(name, loader=None, is_package=True)
    sys.modules[name] = importlib.util.module_from_spec(spec)
    sys.modules[name].__path__ = [str(Path(root, *name.split(".")))]
from tests.engine import conftest
unwrapped = lambda fixture: getattr(fixture, "__wrapped__", None) or fixture.__pytest_wrapped__.obj
ctx = moderngl.create_standalone_context(require=330, backend="egl")
assert ctx.version_code == int(float(version) * 100 + 0.5), ctx.version_code
camera = unwrapped(conftest.camera)()
"""


def run_elsewhere(older_opengl, version, code, *arguments):
    """Run code that has `ctx`, `camera`, `conftest`, `unwrapped` and the `arguments`, texts."""
    whole = PREPARE + code + '\nassert ctx.error == "GL_NO_ERROR"\n'
    environment = {**older_opengl(version), "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    command = [sys.executable, "-W", "error", "-c", whole, str(ROOT), version, *map(str, arguments)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=280)
    assert done.returncode == 0, done.stderr[-3000:]
