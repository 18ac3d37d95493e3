"""Which variant of Lin, Ma & Lo (2016) the published numbers support: one score, with its uncertainty."""
