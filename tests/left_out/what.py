"""How it is written down what a scene is made of."""

from dataclasses import dataclass

KINDS = ("ran", "features", "resolve", "passes", "buffers", "packages", "modules")


@dataclass(frozen=True)
class What:
    """Names, with commas between.

    Attributes
    ----------
    ran : str
        Shader files of the programs that ran.
    features : str
        Switches of these programs that were on.
    resolve : str
        Pieces in VTK's own shader.
    passes, buffers : str
        As ``explain()`` tells them.
    packages : str
        Of others, that were imported.
    modules : str
        Of this package, that the scene asked for; those that they import come with them.
    """

    ran: str = ""
    features: str = ""
    resolve: str = ""
    passes: str = ""
    buffers: str = ""
    packages: str = ""
    modules: str = ""

    def names(self, kind: str) -> set[str]:
        """Return the names of one kind."""
        return {" ".join(name.split()) for name in getattr(self, kind).split(",") if name.strip()}
