"""The studies of the codec, of whole tractograms, and of what compressed lines show; other codecs in ``baselines``."""
