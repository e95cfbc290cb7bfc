"""Slices of images: what lies on a plane, its colours, labels and glyphs; nothing here knows of OpenGL or VTK.

``image`` takes images from every kind of source, on any grid and affine. ``frames`` says where planes lie and which
pixels they have. ``colours`` makes colours of values and lays layers over each other; ``labels`` reads tables of names
and colours. Drawing is in `pvfiblets.plotting.slices`.
"""
