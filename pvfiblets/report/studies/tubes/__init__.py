"""The study of ray-cast spline tubes: solvers, pictures, sweeps."""
