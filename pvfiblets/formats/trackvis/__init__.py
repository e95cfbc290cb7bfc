"""TrackVis files (``.trk``, ``.trk.gz``). Start with ``trk.py``."""
