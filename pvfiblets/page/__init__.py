"""Pages that draw by themselves: one file, or a folder, that any browser with WebGL 2 opens without a server.

`scene` says what a page shows and `writing` writes it. The page's own script is built from the repository's ``client``
folder (`make client`) into ``page.js`` here, and decodes fiblets on the graphics card as the engine does.
`pvfiblets.plotting.page.page_scene` makes such a scene of a plotter.
"""
