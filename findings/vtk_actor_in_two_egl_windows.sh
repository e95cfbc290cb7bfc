#!/usr/bin/env bash
# VTK 9.7.2: one actor in two EGL windows blanks both, for good and without a word.
#
# VTK lets an actor be in several renderers. In two windows of one process its mapper moves its buffers to the window that
# draws: where windows are X's, both show it, in any order. With EGL windows, which VTK takes where there is no display, the
# second window stays blank, and from then on the first one too. Nothing is printed. While the mapper gives up what it had in
# the other window, that window's context becomes current and stays so. Actors with a mapper each are drawn in both.
#
# Needs EGL (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check vtk==9.7.2 numpy==2.3.5
cd "$work"
VTK_DEFAULT_OPENGL_WINDOW=vtkEGLRenderWindow "$work/venv/bin/python" - <<'CODE'
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter,
)

sphere = vtkSphereSource()


def sphere_actor():
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(sphere.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor


def window_of(actor):
    window, renderer = vtkRenderWindow(), vtkRenderer()
    window.SetOffScreenRendering(True)
    window.SetSize(100, 100)
    renderer.AddActor(actor)
    window.AddRenderer(renderer)
    return window


def lit_pixels(window):
    window.Render()
    reader = vtkWindowToImageFilter()
    reader.SetInput(window)
    reader.ReadFrontBufferOff()
    reader.ShouldRerenderOff()
    reader.Update()
    return int((vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).max(axis=1) > 0).sum())


kind = type(vtkRenderWindow()).__name__
print("vtk", vtkVersion.GetVTKVersion(), kind)
assert kind == "vtkEGLRenderWindow", "this machine has no EGL"
shared = sphere_actor()
first, second = window_of(shared), window_of(shared)
one = [lit_pixels(window) for window in (first, second, first, second)]
print("lit pixels, one actor in both windows: first", one[0], "second", one[1], "first again", one[2], "second again", one[3])
first, second = window_of(sphere_actor()), window_of(sphere_actor())
own = [lit_pixels(window) for window in (first, second, first, second)]
print("lit pixels, an actor for each:", *own)
assert one[0] > 1000 and one[1:] == [0, 0, 0]
assert min(own) > 1000
CODE
