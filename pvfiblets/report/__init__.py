"""Error against run time of every approximation in the program, and speed, from one command: ``pvfiblets report``.

A *study* (:mod:`.study`) compares one approximation with its baselines and settings and gives *records*
(:mod:`.record`), all of one form: error figures with units, costs, and run times as the median and spread of repeats.
A report is the file ``report.json`` (:mod:`.report_file`); the Markdown page (:mod:`.page`) and the plots
(:mod:`.plots`) read that file alone, so that they can be made again, or changed, without new measurements.

:mod:`.studies` lists the studies and explains how to add one. They draw on bare contexts (:mod:`.drawing`), or in
windows beside VTK (:mod:`.window`); matplotlib is imported when plots are made.
"""
