"""Error against run time of every approximation in the program, from one command: ``pvfiblets report``.

A *study* (:mod:`.study`) measures one approximation beside its baselines and settings and gives *records*
(:mod:`.record`), all of one form: error figures with units, costs, and run times as the median and spread of repeats. A
report is the file ``report.json`` (:mod:`.report_file`); the Markdown page (:mod:`.page`) and the plots
(:mod:`.plots`) are made from that file alone, so that they can be made again, or differently, without measuring.

Studies are named in :mod:`.studies`, which says how one is added. They draw by the engine alone, without VTK, but for
:mod:`.features_window`; matplotlib is imported when plots are made.
"""
