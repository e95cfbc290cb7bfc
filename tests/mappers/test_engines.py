"""What the mapper asks of the engine, and when it asks anew."""

from __future__ import annotations

from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.mappers import EngineOptions, FibletMapper


def recording(plain):
    """Return a mapper on GL lines, its actor, and the list of keywords that its renderers were made with."""
    asked = []
    factory = plain.mapper()._factory

    def make(ctx, fiblets, **options):
        asked.append(options)
        return factory(ctx, fiblets)

    def build(**arguments):
        mapper, actor = FibletMapper(plain.fiblets, renderer_factory=make, **arguments), vtkActor()
        mapper.attach(actor)
        return mapper, actor

    return build, asked


def test_only_what_is_not_the_default_is_asked_for():
    assert EngineOptions().changed() == {}
    assert EngineOptions("geometry", "coverage", "sample").changed() == {
        "pipeline": "geometry", "culling": "coverage", "fit": "sample"
    }  # fmt: skip
    assert EngineOptions(culling="none") == EngineOptions(culling=None)
    assert EngineOptions(culling="none").changed() == {"culling": None}


def test_other_options_make_another_renderer_at_the_next_frame(make_plotter, plain, standins, tools):
    build, asked = recording(plain)
    mapper, actor = build(options=EngineOptions(pipeline="geometry"))
    plotter = make_plotter()
    plotter.add_actor(actor)
    first = tools.picture(plotter, mapper)
    assert asked == [{"pipeline": "geometry"}]
    mapper.options = EngineOptions(pipeline="geometry")
    tools.picture(plotter, mapper)
    assert len(asked) == 1
    before = actor.GetMTime()
    mapper.options = EngineOptions(culling=None)
    assert actor.GetMTime() > before, "who renders on demand must see the change"
    assert len(asked) == 1, "nothing is made outside a frame"
    assert (tools.picture(plotter, mapper) == first).all()
    assert asked == [{"pipeline": "geometry"}, {"culling": None}]
    assert [renderer.released for renderer in standins] == [True, False]


def test_progress_is_passed_on_and_makes_nothing_anew(make_plotter, plain, tools):
    build, asked = recording(plain)
    mapper, actor = build(progress=True)
    plotter = make_plotter()
    plotter.add_actor(actor)
    tools.picture(plotter, mapper)
    assert asked == [{"progress": True}]


def test_the_pipeline_in_use_is_known_after_the_first_frame(make_plotter, plain, standins, tools):
    build, _ = recording(plain)
    mapper, actor = build()
    assert mapper.pipeline_in_use is None
    plotter = make_plotter()
    plotter.add_actor(actor)
    tools.picture(plotter, mapper)
    standins[0].pipeline = "lines"
    assert mapper.pipeline_in_use == "lines"
    mapper.release()
    assert mapper.pipeline_in_use is None
