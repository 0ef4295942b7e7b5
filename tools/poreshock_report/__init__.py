"""Report of an output folder: reading (folder), pictures (figures) and the page itself (page)."""
