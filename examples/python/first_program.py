import gonio
prior = gonio.read_prior("materials.prior")
samples = gonio.read_samples("measurements.csv")
paint = gonio.Decomposition(prior, eta=40.0).fit(samples)
gonio.write_merl("paint.binary", paint)
