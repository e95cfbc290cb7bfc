"""The ``pvfiblets`` command: a module for each subcommand, begun by `main`.

Nothing here computes or draws: commands check their arguments, call the package, and print. Start with ``command.py``.
"""

from .command import main

__all__ = ["main"]
