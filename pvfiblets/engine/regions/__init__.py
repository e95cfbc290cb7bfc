"""Regions of space as shaders know them: which points they hold, and where pixels' rays cross their boundaries."""
