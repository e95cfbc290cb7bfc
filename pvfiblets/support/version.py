"""The version, for whatever keeps something on disk for the next program."""

__version__ = "0.1.0"
