"""What can be asked of a mapper about what it drew, in whichever windows show it."""

from __future__ import annotations

from typing import Any, cast

from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.mappers.picking import pick
from pvfiblets.mappers.windows import contexts_with


class Questions:
    """The part of `pvfiblets.mappers.FibletMapper` that answers."""

    _last_drawn: str | None
    _fiblets: Any

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve shader in use."""
        raise NotImplementedError

    @property
    def _address(self) -> str:
        """What windows know the mapper by."""
        return str(cast("Any", self).GetAddressAsString(""))

    def pick_at(
        self, x: float, y: float, *, renderer: vtkRenderer | None = None, tolerance: int = 2
    ) -> tuple[int, float] | None:
        """Return the streamline nearest to a pixel of what was drawn last.

        Parameters
        ----------
        x, y : float
            Pixel of the window, from its lower left corner, as VTK's events give it.
        renderer : vtkRenderer, optional
            Which renderer's picture to look into; by default the one that was drawn last.
        tolerance : int, default 2
            How many pixels away a line may be.

        Returns
        -------
        tuple of int and float, or None
            Streamline id and position along it: the index of the point before, plus the fraction of
            the segment. None where there is no fiblet. Other actors in front are not looked at.
        """
        key = self._last_drawn if renderer is None else renderer.GetAddressAsString("")
        for context in contexts_with(self):
            slot = context.slots[self._address]
            drawn = slot.drawn.get(key or "")
            if drawn is not None and slot.renderer is not None and context.alive:
                context.window.MakeCurrent()
                with context.foreign():
                    return pick(context.ctx, slot.renderer, drawn, (x, y), tolerance)
        return None

    @property
    def pipeline_in_use(self) -> str | None:
        """Name of the pipeline that drew the last picture; None before the first."""
        return next((getattr(renderer, "pipeline", None) for renderer in self._renderers()), None)

    @property
    def share(self) -> float | None:
        """Least share of the streamlines that a window draws: 1.0 but for ``fit='sample'``; None before the first."""
        return min((getattr(renderer, "share", 1.0) for renderer in self._renderers()), default=None)

    def _renderers(self) -> list[Any]:
        """Return the engine's renderers of all windows."""
        slots = [context.slots[self._address] for context in contexts_with(self)]
        return [slot.renderer for slot in slots if slot.renderer is not None]

    def explain(self) -> dict[str, Any]:
        """Return what is active: the engine's passes, features and buffers, and the resolve's.

        Returns
        -------
        dict
            Keys of the engine's ``explain`` per window in ``windows``; ``features``: pieces of the resolve
            shader; ``textures``: name and bytes of the mapper's own textures and those of its extras.
        """
        windows, textures = [], []
        for context in contexts_with(self):
            slot = context.slots[self._address]
            if slot.renderer is not None and context.alive:
                context.window.MakeCurrent()
                with context.foreign():
                    windows.append(slot.renderer.explain())
                    for _, kept in slot.extras.values():
                        if hasattr(kept, "explain"):
                            costs = kept.explain()
                            windows[-1]["passes"] += costs["passes"]
                            textures += costs["buffers"]
            textures += [
                {"name": name, "bytes": texture.width * texture.height * texture.components}
                for name, texture in slot.textures.items()
            ]
        return {"features": sorted(self.features), "textures": textures, "windows": windows}

    def region_flags(self, region: Any, sampling: float | None = None) -> Any:
        """Say how each streamline lies to a region, by the GPU of a window that draws it, else by the CPU.

        Parameters
        ----------
        region, sampling
            Data coordinates; as in `pvfiblets.codec.query.passing.region_flags`, which gives the same answer.

        Returns
        -------
        numpy.ndarray
            (n_streamlines,) uint8.
        """
        for context in contexts_with(self):
            slot = context.slots[self._address]
            current = slot.versions.get("fiblets") is self._fiblets
            if slot.renderer is not None and current and context.alive and hasattr(slot.renderer, "query"):
                context.window.MakeCurrent()
                with context.foreign():
                    return slot.renderer.query(region, sampling)
        from pvfiblets.codec.query.passing import region_flags

        return region_flags(self._fiblets, region, sampling)
