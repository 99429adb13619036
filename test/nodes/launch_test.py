#!/usr/bin/env python3
"""Launch files: each loads, names nodes that exist, and documents its arguments. Wrong settings end a node with code 2."""
import glob
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

import roslaunch.config
import roslaunch.xmlloader
import roslib.packages
import rospkg
import rosparam
import rostest
import yaml

PACKAGE = rospkg.RosPack().get_path('tissue_stiffness')
DATA = os.path.join(PACKAGE, 'test', 'data', 'case_01')
ARGUMENTS = ['model:=%s/model.yaml' % DATA, 'bag:=%s/recording.bag' % DATA]
MODEL = open(os.path.join(DATA, 'model.yaml')).read()


def launch_files():
    return sorted(glob.glob(os.path.join(PACKAGE, 'launch', '*.launch')))


def run(node, *arguments):
    """Exit code and output of a node that is expected to end by itself."""
    executable = roslib.packages.find_node('tissue_stiffness', node)[0]
    done = subprocess.run([executable] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=30,
                          universal_newlines=True)
    return done.returncode, done.stdout


class LaunchTest(unittest.TestCase):
    def test_every_launch_file_loads(self):
        self.assertGreaterEqual(len(launch_files()), 5)
        for file in launch_files():
            declared = [arg.get('name') for arg in xml.parse(file).getroot().findall('arg')]
            given = [argument for argument in ARGUMENTS if argument.split(':=')[0] in declared]
            config = roslaunch.config.ROSLaunchConfig()
            roslaunch.xmlloader.XmlLoader(resolve_anon=False).load(file, config, argv=given, verbose=False)
            self.assertEqual(config.config_errors, [], file)
            own = [node.type for node in config.nodes if node.package == 'tissue_stiffness']
            for node in ('mesh_node', 'segmentation_node', 'estimator_node'):
                self.assertIn(node, own, file)
            for node in own:
                self.assertTrue(roslib.packages.find_node('tissue_stiffness', node), '%s: no node %s' % (file, node))

    def test_arguments_are_documented(self):
        for file in launch_files():
            for arg in xml.parse(file).getroot().findall('arg'):
                self.assertTrue(arg.get('doc'), '%s: argument %s' % (file, arg.get('name')))

    def test_a_wrong_model_is_one_line_and_code_2(self):
        with tempfile.TemporaryDirectory() as folder:
            wrong = os.path.join(folder, 'wrong.yaml')
            with open(wrong, 'w') as file:
                file.write(MODEL.replace('noise: 0.0003', 'noise: -1'))
            for node in ('mesh_node', 'segmentation_node', 'estimator_node'):
                code, output = run(node, '_model:=' + wrong, '__name:=wrong_' + node)
                self.assertEqual(code, 2, output)
                for part in (wrong, 'noise', '-1'):
                    self.assertIn(part, output)
                self.assertEqual(len(output.strip().splitlines()), 1, output)

    def test_a_wrong_effect_ends_the_estimator_once_the_mesh_is_there(self):
        with tempfile.TemporaryDirectory() as folder:
            wrong = os.path.join(folder, 'wrong.yaml')
            with open(wrong, 'w') as file:
                file.write(MODEL.replace('acceleration', 'aceleration'))
            code, output = run('estimator_node', '_model:=' + wrong, '__name:=wrong_effect')
            self.assertEqual(code, 2, output)
            self.assertIn('acceleration', output)

    def test_a_missing_model_is_named(self):
        code, output = run('estimator_node', '_model:=/nowhere/model.yaml', '__name:=lost')
        self.assertEqual(code, 2, output)
        self.assertIn('/nowhere/model.yaml', output)

    def test_a_model_file_and_keys_of_a_model_do_not_mix(self):
        code, output = run('estimator_node', '_model:=%s/model.yaml' % DATA, '_estimator:=paper', '__name:=mixed')
        self.assertEqual(code, 2, output)
        self.assertIn('estimator', output)

    def test_a_model_of_parameters_reads_no_file_outside_its_directory(self):
        model = yaml.safe_load(MODEL)
        model['mesh']['file'] = '../case_01/../meshing/cube.stl'
        for node in ('mesh_node', 'segmentation_node', 'estimator_node'):
            rosparam.upload_params('/outside_' + node, dict(model, directory=DATA))
            code, output = run(node, '__name:=outside_' + node)
            self.assertEqual(code, 2, output)
            for part in ('mesh.file: found ../case_01/../meshing/cube.stl', DATA + ', or the parameter allow_outside'):
                self.assertIn(part, output)
        # With the parameter the next thing that is wrong is named.
        rosparam.upload_params('/allowed', dict(model, directory=DATA, allow_outside=True, queue_size=0))
        code, output = run('estimator_node', '__name:=allowed')
        self.assertEqual(code, 2, output)
        self.assertIn('queue_size', output)

    def test_an_own_parameter_out_of_range(self):
        code, output = run('estimator_node', '_model:=%s/model.yaml' % DATA, '_queue_size:=0', '__name:=empty_queue')
        self.assertEqual(code, 2, output)
        self.assertIn('queue_size', output)


if __name__ == '__main__':
    rostest.rosrun('tissue_stiffness', 'launch', LaunchTest, sys.argv)
