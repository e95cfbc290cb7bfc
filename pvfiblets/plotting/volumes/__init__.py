"""``plotter.add_raycast_volume(...)``: the component, its actor, and its transfer function."""
