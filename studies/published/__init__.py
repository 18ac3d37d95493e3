"""The papers' own numbers, for overlays and pass or fail bands. One module a paper."""
