"""Fiblets on the GPU: uploaded once, then culled, decoded and drawn into a G-buffer by one of several pipelines."""
