"""The study of ray-cast volumes: integrators, occlusion, pictures."""
