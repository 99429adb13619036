"""Tables, pictures, and the files that the tool `estimate` wrote."""
import os
import sys
import unittest
from unittest import mock

import numpy as np
import tissue_stiffness as ts
from bench import INERTIA, PULL, PULLED, Bench, elasticity, unknown


class ResultsTest(Bench):
    def estimate(self, unknowns=elasticity(unknown(2.4e4)), truth=elasticity(1.2e4)):
        """The result of a bag, and the tool's."""
        bag = self.simulate(INERTIA + PULL + truth, PULLED)
        model = self.write_model(INERTIA + PULL + unknowns)
        self.tool('estimate', model, bag, '--output', self.folder)
        return ts.estimate(model, bag), ts.read_results(self.path('results.json'))

    def test_what_the_tool_wrote_gives_the_same_table(self):
        here, read = self.estimate()
        mine, theirs = here.columns(), read.columns()
        self.assertEqual(list(mine), ['stamp', 'E', 'lower', 'upper', 'state', 'misfit', 'used'])
        self.assertEqual(list(mine), list(theirs))
        for name in mine:
            np.testing.assert_array_equal(mine[name], theirs[name], name)
        self.assertEqual(len(mine['E']), len(here.frames))
        self.assertEqual((here.young_modulus, here.interval, here.state), (read.young_modulus, read.interval, read.state))
        self.assertEqual((mine['E'][-1], mine['lower'][-1]), (here.young_modulus, here.interval[0]))
        self.assertEqual({name: i.reason for name, i in here.identifiable.items()},
                         {name: i.reason for name, i in read.identifiable.items()})
        self.assertTrue(read.complete)
        self.refuses(lambda: read.columns('gravity'), 'parameter: found gravity', 'elasticity.young_modulus')

    def test_each_parameter_has_a_table_and_all_are_drawn(self):
        here, read = self.estimate(elasticity(unknown(2e4), 'near') + elasticity(unknown(2e4), 'far'),
                                   elasticity(1.2e4, 'near') + elasticity(3e4, 'far'))
        self.refuses(here.columns, '2 moduli', 'elasticity#2.young_modulus')
        far = read.columns('elasticity#2.young_modulus')
        np.testing.assert_array_equal(here.columns('elasticity#2.young_modulus')['E'], far['E'])
        self.assertEqual(far['E'][-1], read.parameters['elasticity#2.young_modulus'].mean)
        self.assertGreater(far['E'][-1], 1.5 * read.columns('elasticity.young_modulus')['E'][-1])
        file = self.path('both.png')
        figure = here.plot(file)
        self.assertEqual(len(figure.axes), 2)
        np.testing.assert_array_equal(figure.axes[1].lines[0].get_ydata(), far['E'])
        with open(file, 'rb') as picture:
            self.assertEqual(picture.read(8), b'\x89PNG\r\n\x1a\n')
        self.assertEqual(len(read.plot(parameter='elasticity.young_modulus').axes), 1)

    def test_the_table_is_a_data_frame_where_pandas_is(self):
        here, _ = self.estimate()
        with mock.patch.dict(sys.modules, {'pandas': None}):  # as if it were not installed
            plain = here.table()
        self.assertIsInstance(plain, dict)
        import pandas
        table = here.table()
        self.assertIsInstance(table, pandas.DataFrame)
        self.assertEqual(list(table.columns), list(plain))
        np.testing.assert_array_equal(table['E'], plain['E'])

    def test_other_files_are_named(self):
        allowed = 'results.json of the tool'
        self.refuses(lambda: ts.read_results(self.path('none.json')), 'none.json', 'No such file', allowed)
        self.refuses(lambda: ts.read_results(self.write('a.json', 'E = 5')), 'a.json: found no JSON', allowed)
        self.refuses(lambda: ts.read_results(self.write('b.json', '[]')), 'b.json', allowed)
        self.refuses(lambda: ts.read_results(self.write('c.json', '{"verdict": "adequate"}')), 'c.json', 'model', allowed)
        self.estimate()
        os.remove(self.path('estimates.csv'))
        self.refuses(lambda: ts.read_results(self.path('results.json')), 'estimates.csv', 'beside results.json')
        self.write('estimates.csv', 'time,E\n0,1\n')
        self.refuses(lambda: ts.read_results(self.path('results.json')), 'estimates.csv: found another table')

    def test_a_bag_needs_the_part_that_reads_bags(self):
        model = self.write_model(INERTIA + PULL + elasticity(unknown(2.4e4)))
        with mock.patch.dict(sys.modules, {'tissue_stiffness._bag': None}):
            self.refuses(lambda: ts.estimate(model, 'recording.bag'), 'recording.bag: found a rosbag', 'frames of arrays')
        self.refuses(lambda: ts.estimate(model, self.path('none.bag')), 'none.bag')


if __name__ == '__main__':
    unittest.main()
