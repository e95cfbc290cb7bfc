"""The study of queries: similar streamlines, clusters, and painted regions."""
