"""What the resolve's own pieces read: textures by the names of their samplers, and uniforms of VTK's program."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pvfiblets.mappers.colouring import Colouring
    from pvfiblets.mappers.scene import Frame
    from pvfiblets.mappers.windows import Slot

__all__ = ["resolve_textures", "set_uniforms"]


def resolve_textures(ctx: Any, slot: Slot, buffer: Any, colouring: Colouring) -> dict[str, Any]:
    """Return the textures of the G-buffer and of the colours by the names of their samplers."""
    textures = {"fibletDepthMap": buffer.depth, "fibletIdMap": buffer.ids}
    features = colouring.features
    lists: dict[str, Any] = {}
    if "colour_streamline" in features:
        lists["fibletStreamlineColours"] = colouring.streamline_colours
    elif "colour_point_scalar" in features:
        textures["fibletPositionMap"] = buffer.position
        lists["fibletTable"] = colouring.table
    elif "colour_point_packed" in features:
        textures["fibletPositionMap"] = buffer.position
    elif "colour_point_rgba" in features:
        textures["fibletColourMap"] = buffer.colours
    if "opacity_streamline" in features:
        lists["fibletOpacities"] = colouring.streamline_opacities
    if "opacity_point" in features:
        textures["fibletPositionMap"] = buffer.position
    for unused in set(slot.textures) - set(lists):
        slot.textures.pop(unused).release()
    for name, pixels in lists.items():
        textures[name] = slot.list_texture(name, colouring, pixels, ctx)
    return textures


def set_uniforms(program: Any, frame: Frame, style: Any, fiblets: Any, colouring: Colouring) -> None:
    """Set place, camera and colours of a draw; the ``vtkShaderProgram`` is bound."""
    x, y, width, height = frame.viewport
    program.SetUniform2i("fibletOrigin", (x, y))
    program.SetUniform2i("fibletSize", (width, height))
    # Decoded points may lie outside the bounds, by as much as the promise.
    slack = fiblets.promise + style.reach
    rectangle = frame.rectangle(fiblets.bounds, slack, style.half_width + 2.0)
    program.SetUniform4f("fibletRectangle", rectangle)
    # VTK takes matrices column by column here.
    program.SetUniformMatrix4x4("fibletPixelToView", frame.pixel_to_view.T.ravel().tolist())
    program.SetUniformMatrix3x3("fibletDataToView", frame.directions_to_view.T.ravel().tolist())
    if colouring.mode == "solid":
        program.SetUniform3f("fibletColour", colouring.color)
    if "colour_point_scalar" in colouring.features and colouring.lut is not None:
        program.SetUniformi("fibletTableSize", len(colouring.lut))
        reference = getattr(colouring.source, "reference", None)  # of an image
        if reference is None:
            reference = fiblets.value_reference(colouring.source)
        program.SetUniform3f("fibletTableRange", colouring.scaled_range(reference=reference))
        if colouring.log_scale:
            program.SetUniformf("fibletTableReference", reference)
