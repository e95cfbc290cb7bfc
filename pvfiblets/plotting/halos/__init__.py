"""``plotter.add_halo_lines(...)`` and ``add_halo_points(...)``: components, actors and scalars."""
