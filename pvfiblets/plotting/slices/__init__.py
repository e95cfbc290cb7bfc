"""Slices of images in PyVista's plotters, and the workspace of linked panes."""
