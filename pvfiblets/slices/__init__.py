"""Slices of images: pixels of a plane, colours, labels and glyphs, without OpenGL or VTK.

``image`` takes images from every kind of source, on any grid and affine. ``frames`` says where planes lie and which
pixels they have. ``colours`` makes colours of values and lays layers over each other; ``labels`` reads tables of names
and colours. Drawing is in `pvfiblets.plotting.slices`.
"""
