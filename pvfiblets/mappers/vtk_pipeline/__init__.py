"""VTK's half of a mapper: input, scalars, actor, and real lines for the code of VTK that reads them.

It knows no drawable. Start with ``connection.py``.
"""
