"""The study of smooth edges."""
