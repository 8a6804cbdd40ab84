"""Reconstructs a BRDF as the tool does, with numpy arrays: rejects a wrong sample and gives intervals of values."""

import numpy as np

import gonio

samples = gonio.read_samples("measurements.csv")
samples.values[5] *= 20  # changes the samples in place: sample 5 is now wrong

prior = gonio.read_prior()  # the prior that ships with the package
paint = gonio.Estimator(prior, noise=0.02).fit(samples)
print("rejected:", paint.rejected)
for wrong in paint.contradicted:
    print(wrong)

# Light from 30 degrees, and viewers on the opposite side.
theta = np.radians([10, 20, 30, 40, 50])
wi = np.array([np.sin(np.radians(30)), 0, np.cos(np.radians(30))])
wo = np.stack([-np.sin(theta), np.zeros(5), np.cos(theta)], axis=1)
low, high = paint.interval(wi, wo, 0.95)
for angle, value, least, most in zip(np.degrees(theta), paint(wi, wo), low, high):
    print(f"{angle:2.0f} degrees: {value[1]:.3f} sr^-1, between {least[1]:.3f} and {most[1]:.3f}")

directions, delta_e = gonio.next_directions(prior, samples.subset([i for i in range(20) if i != 5]))
print(f"measure next: {np.round(directions[0], 2)}, which leaves a Delta E of {delta_e:.1f}")
