"""Exploration in a browser: ``pvfiblets serve``.

The document (layers, scene, history, session, script) is independent of browsers and of trame. The
server is two kinds of process: one front server, which listens on the public port, authenticates clients and forwards
permitted requests, and for every browser session one worker, a trame application with its own scene and OpenGL context.
"""
