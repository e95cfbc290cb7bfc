"""Connectomes as nodes and edges: the component and the graph that it adds."""
