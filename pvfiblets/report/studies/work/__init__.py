"""The study of work: what a frame of fiblets asks of a graphics card, counted."""
