"""Bundles: streamlines that run alike, found, listed, measured."""
