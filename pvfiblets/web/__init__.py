"""Exploration in a browser: ``pvfiblets serve``.

The document (layers, scene, history, session, script) knows nothing of browsers and is imported without trame. The
server is two kinds of process: one gate, which listens on the public port, checks who asks and passes on what may
pass, and for every browser session one worker, a trame application with its own scene and OpenGL context.
"""
