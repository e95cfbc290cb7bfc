"""``pvfiblets gl``: what it prints, and what it says where there is no OpenGL."""

from __future__ import annotations

import json
import os
import subprocess
import sys

from pvfiblets.cli import main
from pvfiblets.engine.capabilities import PIPELINES


def test_gl_lists_the_driver_its_limits_and_every_pipeline(gl, capsys):
    assert gl.info["GL_VERSION"]
    assert main(["gl"]) == 0
    text = capsys.readouterr().out
    assert gl.info["GL_RENDERER"] in text
    assert gl.info["GL_VERSION"] in text
    assert f"{gl.info['GL_MAX_TEXTURE_SIZE']:,}" in text
    for name in PIPELINES[1:]:
        assert sum(line.split()[:1] == [name] for line in text.splitlines()) == 1
    assert text.count("(auto)") == 1


def test_gl_as_json_is_one_object(gl, capsys):
    assert gl.extensions
    assert gl.info
    assert main(["gl", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["renderer"] == gl.info["GL_RENDERER"]
    assert set(report["extensions"]) == set(gl.extensions)
    assert {entry["name"] for entry in report["pipelines"]} == set(PIPELINES[1:])
    assert all(entry["available"] == (entry["why_not"] is None) for entry in report["pipelines"])
    assert report["auto"] == next(entry["name"] for entry in report["pipelines"] if entry["available"])


def test_without_opengl_there_is_one_sentence_and_exit_code_1():
    nothing = {"GLCONTEXT_LINUX_LIBEGL": "libnothing.so", "GLCONTEXT_LINUX_LIBGL": "libnothing.so"}
    result = subprocess.run(
        [sys.executable, "-m", "pvfiblets.cli", "gl"],
        capture_output=True, text=True, check=False, env=os.environ | nothing,
    )  # fmt: skip
    assert (result.returncode, result.stdout, result.stderr.count("\n")) == (1, "", 1)
    assert result.stderr.startswith("pvfiblets: no OpenGL 3.2 or later could be started on this machine (egl: ")
    assert "Install a graphics driver" in result.stderr
