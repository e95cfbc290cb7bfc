"""Images of voxels: read from files of every format and from objects of other libraries, and sampled at points.

``sources`` takes an image wherever one may be given: the path of a file, ``(array, affine)``, an image of nibabel or
of VTK. ``files`` knows the suffixes, and one module reads each format. ``image`` holds the numbers and where they lie;
``sampling`` interpolates them. Without OpenGL; VTK is imported for its own files only.
"""
