import gonio
prior = gonio.read_prior("materials.prior")
samples = gonio.read_samples("measurements.csv")
paint = gonio.Estimator(prior).fit(samples)
gonio.write_merl("paint.binary", paint)
