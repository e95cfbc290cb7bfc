"""How fiblets become pixels. Each pipeline fills the same G-buffer from the same chunks."""
