"""What can be asked of a mapper about what it drew, in whichever windows show it."""

from __future__ import annotations

from typing import Any, cast

from pvfiblets.mappers.windows import contexts_with


class Questions:
    """The part of `pvfiblets.mappers.engine_mapper.EngineMapper` that answers."""

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve shader in use."""
        raise NotImplementedError

    @property
    def _address(self) -> str:
        """What windows know the mapper by."""
        return str(cast("Any", self).GetAddressAsString(""))

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
            shader; ``textures``: name and bytes of the mapper's own textures and those of its effects.
        """
        windows, textures = [], []
        for context in contexts_with(self):
            slot = context.slots[self._address]
            if slot.renderer is not None and context.alive:
                context.window.MakeCurrent()
                with context.foreign():
                    windows.append(slot.renderer.explain())
                    for share, thinned in slot.thinned.items():
                        size = 0 if thinned is None else sum(one["bytes"] for one in thinned.explain()["buffers"])
                        windows[-1]["buffers"].append({"name": f"{share:.3g} of the streamlines", "bytes": size})
                    for _, kept in slot.effects.values():
                        if hasattr(kept, "explain"):
                            costs = kept.explain()
                            windows[-1]["passes"] += costs["passes"]
                            windows[-1]["features"] = sorted({*windows[-1]["features"], *costs.get("features", ())})
                            textures += costs["buffers"]
            textures += [
                {"name": name, "bytes": texture.width * texture.height * texture.components}
                for name, texture in slot.textures.items()
            ]
        return {"features": sorted(self.features), "textures": textures, "windows": windows}
