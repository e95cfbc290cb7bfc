"""Methods of PyVista's plotters that this package extends: exports, screenshots, and picking of visible cells.

All but pictures for print (``screenshot.py``) replace PyVista's methods on import. Start with ``exports.py``.
"""
