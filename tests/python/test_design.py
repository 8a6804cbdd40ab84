import unittest

import numpy as np

import gonio
from surroundings import MEASUREMENTS, PRIOR, unit


class DesignTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.prior = gonio.read_prior(PRIOR)
        cls.two, cls.three = (gonio.design(cls.prior, count, search="greedy") for count in (2, 3))

    def test_more_directions_leave_less_unknown(self):
        self.assertLess(self.three.unknown_share, self.two.unknown_share)
        self.assertLess(self.two.unknown_share, 1)

    def test_its_directions_are_worth_what_it_says(self):
        self.assertEqual(self.three.directions.shape, (3, 6))
        again = gonio.expected_error(self.prior, self.three.directions)
        self.assertAlmostEqual(again.expected_error, self.three.expected_error, places=6)

    def test_better_than_the_same_number_at_random(self):
        generator = np.random.default_rng(1)
        random = np.hstack([unit(generator.uniform(0, 1.2, 3), generator.uniform(0, 6, 3)) for _ in range(2)])
        self.assertLess(self.three.expected_error, gonio.expected_error(self.prior, random).expected_error)

    def test_adds_to_what_is_measured(self):
        more = gonio.design(self.prior, 3, search="greedy", start=self.two.directions)
        np.testing.assert_allclose(more.directions, self.three.directions, atol=1e-9)

    def test_next_directions(self):
        samples = gonio.read_samples(MEASUREMENTS)
        directions, remaining = gonio.next_directions(self.prior, samples, 2)
        self.assertEqual(directions.shape, (2, 6))
        self.assertGreater(remaining, 0)

    def test_published_directions(self):
        self.assertEqual(gonio.published_directions(5).shape, (5, 6))
        np.testing.assert_allclose(np.linalg.norm(gonio.published_directions()[:, 3:], axis=1), 1)

    def test_refusals(self):
        for call, sentence in [
            (lambda: gonio.design(self.prior, 3, criterion="luck"), "criterion is 'luck': expected one of "),
            (lambda: gonio.design(self.prior, 3, geometry="cube"), "geometry is 'cube': expected one of "),
            (lambda: gonio.design(self.prior, 3, start=[[1, 2]]), "start has shape (1, 2): expected (n, 6) or (n, 3)"),
            (lambda: gonio.design(self.prior, 0), ""),
            (lambda: gonio.published_directions(3), "there is no published set of 3 directions"),
            (lambda: gonio.next_directions(self.prior, gonio.read_samples(MEASUREMENTS), 0), "count is 0"),
        ]:
            with self.subTest(sentence=sentence), self.assertRaises(gonio.Error) as raised:
                call()
            self.assertTrue(str(raised.exception).startswith(sentence), str(raised.exception))


if __name__ == "__main__":
    unittest.main()
