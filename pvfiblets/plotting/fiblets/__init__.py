"""``plotter.add_fiblets(...)``: component and actor, with filters, cuts, picking and selection."""
