"""The study of decoding: what order, number format, table and algebra cost."""
