"""Read by catkin: cmake/python_package.cmake."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['tissue_stiffness'], package_dir={'': 'src/python'},
                                 package_data={'tissue_stiffness': ['py.typed', '*.pyi']}))
