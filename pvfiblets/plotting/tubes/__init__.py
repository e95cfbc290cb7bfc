"""``plotter.add_spline_tubes(...)``: the component, its actor, and the numbers that colour it."""
