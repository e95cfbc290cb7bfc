"""The study of culling: what is left out of a picture, and what that saves."""
