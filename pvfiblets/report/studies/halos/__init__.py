"""The study of halos."""
