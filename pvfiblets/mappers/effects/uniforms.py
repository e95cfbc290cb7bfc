"""Inputs of the resolve's own pieces: textures by the names of their samplers, and uniforms of VTK's program."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.mappers.colouring import Colouring
    from pvfiblets.mappers.frames.scene import Frame
    from pvfiblets.mappers.frames.windows import Slot


def resolve_textures(ctx: moderngl.Context, slot: Slot, buffer: Any, colouring: Colouring) -> dict[str, Any]:
    """Return the textures of the G-buffer and of the colours by the names of their samplers."""
    textures = {"fibletDepthMap": buffer.depth, "fibletIdMap": buffer.ids}
    lists: dict[str, Any] = {}
    if colouring.kind.numbers == "lines":
        lists["colour_list"] = colouring.streamline_colours
    if colouring.maps_on_gpu:
        lists["colour_table"] = colouring.table
    if colouring.reads_value:
        textures["fibletPositionMap"] = buffer.position
    if colouring.kind.reads == "colours":
        textures["fibletColourMap"] = buffer.colours
    if colouring.opacities is not None:
        lists["fibletOpacities"] = colouring.streamline_opacities
    for unused in set(slot.textures) - set(lists):
        slot.textures.pop(unused).release()
    for name, pixels in lists.items():
        textures[name] = slot.list_texture(name, colouring, pixels, ctx)
    return textures


def set_uniforms(program: Any, frame: Frame, style: Any, fiblets: FibletSet, colouring: Colouring) -> None:
    """Set place, camera and colours of a draw; the ``vtkShaderProgram`` is bound."""
    x, y, width, height = frame.viewport
    program.SetUniform2i("fibletOrigin", (x, y))
    program.SetUniform2i("fibletSize", (width, height))
    # Decoded points may lie outside the bounds, by as much as the error bound.
    slack = fiblets.promise + style.reach
    rectangle = frame.rectangle(fiblets.bounds, slack, style.half_width + 2.0)
    program.SetUniform4f("fibletRectangle", rectangle)
    # VTK takes matrices column by column here.
    program.SetUniformMatrix4x4("fibletPixelToView", frame.pixel_to_view.T.ravel().tolist())
    program.SetUniformMatrix3x3("fibletDataToView", frame.directions_to_view.T.ravel().tolist())
    for name, value in colour_uniforms(colouring, fiblets).items():
        if isinstance(value, tuple):
            program.SetUniform3f(name, value)
        elif isinstance(value, int):
            program.SetUniformi(name, value)
        else:
            program.SetUniformf(name, value)


def colour_uniforms(colouring: Colouring, fiblets: FibletSet) -> dict[str, int | float | tuple[float, ...]]:
    """Return the uniforms of ``shaders/colour`` by their names."""
    if not colouring.maps_on_gpu or colouring.lut is None:
        return {} if colouring.kind.numbers or colouring.color is None else {"colour_solid": colouring.color}
    reference = getattr(colouring.source, "reference", None)  # of an image
    if reference is None:
        reference = fiblets.value_reference(colouring.source)
    found: dict[str, int | float | tuple[float, ...]] = {"colour_entries": len(colouring.lut)}
    found["colour_range"] = colouring.scaled_range(reference=reference)
    return {**found, "colour_reference": float(reference)} if colouring.log_scale else found
