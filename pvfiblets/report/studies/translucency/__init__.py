"""The study of lines that one looks through."""
