"""Modules of abut's readers: `abut report` and `abut study`."""
