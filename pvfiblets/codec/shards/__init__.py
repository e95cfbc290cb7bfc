"""Sets in parts: a folder of ``.fiblets`` files, the shards, each of streamlines that lie near each other.

One set that is larger than memory, or than a file should be, is written and read a shard at a time; a view of
one corner of a brain needs the shards of that corner alone. Each shard is an ordinary ``.fiblets`` file.
"""
