"""The study of culling: the culled fiblets of a picture, and the time saved."""
