"""The mean of several pictures of the same scene, kept on the GPU."""

from __future__ import annotations

import moderngl

from .picture_passes import Attachment, PicturePasses

__all__ = ["Accumulation"]

Viewport = tuple[int, int, int, int]


class Accumulation(PicturePasses):
    """Adds pictures up in float32, and draws their mean."""

    def __init__(self, ctx: moderngl.Context) -> None:
        super().__init__(ctx, {})
        self.samples = 0  # pictures that have been added

    def restart(self) -> None:
        """Begin anew with the next picture."""
        self.samples = 0

    def add(
        self,
        colour: Attachment,
        viewport: Viewport,
        shares: moderngl.Texture | None = None,
        *,
        alike: bool = False,
    ) -> None:
        """Add a part of an attachment; the mean of its samples, where it has several a pixel."""
        sums = self._texture("sums", viewport[2:], 4, "f4")
        self._copy(colour, viewport, sums.size, "sums", mixed=self.samples > 0, shares=shares, alike=alike)
        self.samples = 1 if shares is not None else self.samples + 1

    def begin(self, sums: moderngl.Texture) -> None:
        """Begin anew with sums that are there."""
        self._texture("sums", sums.size, 4, "f4")
        with self._plain_state():
            self._pass("mean", self._framebuffer(("sums",)), {"colours": sums}, {"shift": (0, 0), "share": 1.0})
        self.samples = 1

    def show(self, target: Attachment, viewport: Viewport) -> None:
        """Draw the mean into a part of an attachment; all samples of a pixel get the same."""
        self._show("sums", 1.0 / self.samples, target, viewport)

    def keep(self, colour: Attachment, viewport: Viewport, *, alike: bool = False) -> None:
        """Remember a part of an attachment as it is now, until `forget_kept`."""
        self._texture("kept", viewport[2:], 4, "f4" if colour.floats else "f1")
        self._copy(colour, viewport, viewport[2:], "kept", mixed=False, alike=alike)

    def show_kept(self, target: Attachment, viewport: Viewport) -> None:
        """Draw the kept picture into a part of an attachment of the same size."""
        self._show("kept", 1.0, target, viewport)

    @property
    def kept(self) -> bool:
        """Whether something is remembered."""
        return "kept" in self._textures

    def forget_kept(self) -> None:
        """Release the kept picture."""
        if self.kept:
            self._drop("kept")

    def _copy(
        self,
        colour: Attachment,
        viewport: Viewport,
        size: tuple[int, int],
        name: str,
        *,
        mixed: bool,
        shares: moderngl.Texture | None = None,
        alike: bool = False,
    ) -> None:
        features = [*colour.features(alike=alike), *([] if shares is None else ["PICTURE_SHARES"])]
        uniforms = {"samples": colour.samples, "origin": viewport[:2], "corner": (0, 0)}
        textures = {"drawn": self._outside(colour, 4)} | ({} if shares is None else {"shares": shares})
        with self._plain_state():
            if mixed:
                self._ctx.enable(moderngl.BLEND)
                self._ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
                self._ctx.blend_func = moderngl.ONE, moderngl.ONE
            target = self._framebuffer((name,))
            target.viewport = (0, 0, *size)
            self._pass("copy", target, textures, uniforms, features)
            if mixed:
                self._ctx.disable(moderngl.BLEND)
                self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _show(self, name: str, share: float, target: Attachment, viewport: Viewport) -> None:
        x, y = viewport[:2]
        with self._plain_state(), self._onto(target, viewport) as framebuffer:
            uniforms = {"shift": (-x, -y), "share": share}
            self._pass("mean", framebuffer, {"colours": self._textures[name]}, uniforms)
