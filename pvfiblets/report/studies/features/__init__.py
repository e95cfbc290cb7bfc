"""The study of features: what each adds to a scene that has none of the others."""
