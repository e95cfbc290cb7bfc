"""Mappers of every drawable: what VTK selects, memory that is given back, and errors that are raised later."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkRenderingCore import vtkActor, vtkHardwareSelector

from pvfiblets.halos import HaloLines, HaloStyle
from pvfiblets.mappers import FibletMapper, HaloMapper, TubeMapper, VolumeMapper
from pvfiblets.mappers.frames import windows
from pvfiblets.streamlines import Streamlines
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.volumes.raycast_options import RaycastOptions

from .visible_volumes import light, look, volume

BAR = np.array([(-15.0, 0, 0), (0, 0, 0), (15, 0, 0)])


def ball_of(casting):
    return lambda **more: VolumeMapper(volume(lambda p: 12.0 - np.linalg.norm(p, axis=-1), 17), casting, **more)


def fiblets(**more):
    from pvfiblets import compress

    return FibletMapper(compress(Streamlines.from_list([BAR])), line_width=4.0, **more)


def halos(**more):
    look = HaloStyle(2.0, 8.0, 4.0, n_tapered=0, min_width=0.0, smooth=False)
    return HaloMapper(HaloLines(BAR, [0, 3]), look, **more)


MAKERS = {
    "fiblets": fiblets,
    "tubes": lambda **more: TubeMapper(as_spline_tubes(BAR, radius=1.0), **more),
    "halos": halos,
    "light": ball_of(light()),
    "peaks": ball_of(RaycastOptions("mip")),
    "surface": ball_of(RaycastOptions("isosurface", (1.0,))),
}
every = pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS.keys())


@pytest.fixture
def shown(make_plotter):
    def show(mapper):
        actor = vtkActor()
        mapper.attach(actor)
        plotter = make_plotter()
        plotter.add_actor(actor, reset_camera=False)
        return look(plotter), actor

    return show


@pytest.mark.parametrize("cells", [False, True], ids=["actors", "cells"])
@every
def test_vtk_selects_what_shows(shown, tools, make, cells):
    """In the middle and, of halos, beside it: 5 pixels are a mm."""
    mapper = make()
    plotter, actor = shown(mapper)
    before = tools.picture(plotter, mapper)
    for row, wanted in ((100, 1), (110, int(make is halos)), (5, 0)):
        if row == 110 and "casting" in dir(mapper):
            continue
        selector = vtkHardwareSelector()
        selector.SetRenderer(plotter.renderer)
        selector.SetFieldAssociation(vtkDataObject.FIELD_ASSOCIATION_CELLS)
        selector.SetActorPassOnly(not cells)
        selector.SetArea(128, row - 2, 132, row + 2)
        selection = selector.Select()
        assert selection.GetNumberOfNodes() == wanted
        if wanted:
            assert selection.GetNode(0).GetProperties().Get(selection.GetNode(0).PROP()) is actor
    mapper.raise_pending()
    assert np.array_equal(tools.picture(plotter, mapper), before)


@every
def test_memory_is_given_back_and_the_mapper_freed(shown, tools, make):
    mapper = make()
    plotter, actor = shown(mapper)
    assert tools.picture(plotter, mapper).any()
    assert mapper.explain()["windows"]
    mapper.release()
    mapper.release()
    assert not windows.contexts_with(mapper)
    assert mapper.explain()["windows"] == []
    assert tools.picture(plotter, mapper).any()
    plotter.remove_actor(actor)
    plotter.render()
    assert not windows._contexts
    gone = weakref.ref(mapper)
    del mapper, actor
    gc.collect()
    assert gone() is None


@every
def test_a_failing_engine_is_raised_by_the_caller(shown, make):
    def broken(ctx, drawn, **options):
        raise OSError("no memory")

    mapper = make(renderer_factory=broken)
    plotter, _ = shown(mapper)
    plotter.show(auto_close=False)
    with pytest.raises(OSError, match="no memory"):
        mapper.raise_pending()
