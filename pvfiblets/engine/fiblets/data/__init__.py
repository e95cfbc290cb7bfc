"""A fiblet set in graphics memory: chunks of records, values of points, filters, and what fits.

It knows nothing of pipelines. Start with ``chunks.py``.
"""
