"""What studies that draw share."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from pvfiblets.report import drawing, run, studies
from pvfiblets.report.study import Options, Unavailable


def test_a_study_that_draws_has_a_context_and_the_report_its_driver(gl, monkeypatch, tmp_path):
    class Drawing:
        name, title, approximates, axes, notes = "drawing", "Drawing", "", (), ()

        def run(self, options, left_out):
            with drawing.drawing_context(options) as ctx:
                self.version = ctx.info["GL_VERSION"]
                yield from ()

    study = Drawing()
    monkeypatch.setattr(studies, "MODULES", {"drawing": ""})
    monkeypatch.setattr(studies, "find", lambda name: study)
    report = run.make_report(tmp_path, log=lambda line: None)
    assert report.about["driver"] == f"{gl.info['GL_RENDERER']}, {study.version}"


def test_pictures_that_the_processor_draws_are_timed_by_its_time(gl):
    turns = drawing.turns_of(gl)
    turns.add(gl.finish)
    software = "llvmpipe" in gl.info["GL_RENDERER"] or "softpipe" in gl.info["GL_RENDERER"]
    assert turns.timing(0, 1, "frame").clock == ("cpu" if software else "wall")


def test_without_opengl_a_study_is_unavailable_with_the_reason(monkeypatch):
    code = (
        "from pvfiblets.report.drawing import drawing_context\n"
        "from pvfiblets.report.study import Options, Unavailable\n"
        "try:\n"
        "    with drawing_context(Options()):\n"
        "        print('there is one')\n"
        "except Unavailable as error:\n"
        "    print(error)"
    )
    nothing = {"GLCONTEXT_LINUX_LIBEGL": "libnothing.so", "GLCONTEXT_LINUX_LIBGL": "libnothing.so"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          env=os.environ | nothing)  # fmt: skip
    assert done.stdout.startswith("no OpenGL 3.2 or later could be started on this machine")
    monkeypatch.setitem(sys.modules, "moderngl", None)
    with pytest.raises(Unavailable, match="moderngl"), drawing.drawing_context(Options()):
        pass
