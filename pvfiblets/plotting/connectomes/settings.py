"""Arguments of ``add_connectome`` that other calls have, too."""

from __future__ import annotations

from pvfiblets.plotting.settings import shared
from pvfiblets.plotting.settings.settings import Argument, Settings
from pvfiblets.plotting.settings.shared import Common


class EdgeSettings(Settings):
    """Colours of edges; afterwards they are those of the edges' actor."""

    cmap = shared.CMAP
    clim = shared.CLIM
    n_colors = shared.N_COLORS
    log_scale = shared.LOG_SCALE
    opacity = shared.opacity("Of the edges.")


class ConnectomeCommon(Settings):
    """Arguments that say how a connectome comes into the plotter."""

    name = Argument(None, "Replaces the connectome of the same name.", kind="str | None")
    show_scalar_bar = Common.DECLARED["show_scalar_bar"]
    scalar_bar_args = Common.DECLARED["scalar_bar_args"]
    pickable = Common.DECLARED["pickable"]
    user_matrix = Common.DECLARED["user_matrix"]
    reset_camera = Common.DECLARED["reset_camera"]
    render = Common.DECLARED["render"]
