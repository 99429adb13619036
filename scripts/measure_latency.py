"""The latency of the chain: see scripts/measure_latency."""
import argparse
import os
import subprocess
import tempfile
import threading
import time

import rosbag
import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import CameraInfo, Image
from tf2_msgs.msg import TFMessage

import measure_performance
from meshes import box, write_vtk
from tissue_stiffness.msg import StiffnessEstimate

RATE = 30.0  # Hz
WARM = 30    # frames that do not count: the estimate has hardly begun
SCENE = """
mesh: {{file: {mesh}, discretisation_error: false}}
regions: {{table: {{box: {{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}}}}}}
effects:
  - inertia: {{density: 1060}}
  - elasticity: {{law: linear, young_modulus: {modulus}, poisson_ratio: 0.45}}
  - fixed: {{region: table}}
  - gravity: {{acceleration: [1.5, 0, -9]}}
observations:
  - contour: {{image: /camera/image_raw, camera_info: /camera/camera_info, noise: 3e-4}}
"""
SENSOR = """
simulation:
  duration: {seconds}
  rate: {rate}
  step: 0.004
  sensors: {{/camera/image_raw: {{size: [640, 480], focal_length: 4000, position: [0, -1, 0.03], target: [0, 0, 0.03]}}}}
"""


def write_scene(folder, seconds):
    mesh, scene, model = (os.path.join(folder, name) for name in ('block.vtk', 'scene.yaml', 'model.yaml'))
    write_vtk(mesh, *box((0.03, 0.03, 0.06), (3, 3, 10), (-0.015, -0.015, 0.0)))  # 1,029 nodes with those on the edges
    with open(scene, 'w') as file:
        file.write(SCENE.format(mesh=mesh, modulus='6e3') + SENSOR.format(seconds=seconds, rate=RATE))
    with open(model, 'w') as file:
        file.write(SCENE.format(mesh=mesh, modulus='{prior: 9e3, factor: 2}'))
    bag = os.path.join(folder, 'images.bag')
    simulate = roslib.packages.find_node('tissue_stiffness', 'simulate')[0]
    subprocess.run([simulate, scene, '--output', bag], check=True, stdout=subprocess.PIPE)
    return model, bag


def read_bag(bag):
    images, info, transforms = [], None, []
    with rosbag.Bag(bag) as recording:
        for topic, message, _ in recording.read_messages():
            if topic == '/camera/image_raw':
                images.append(message)
            elif topic == '/camera/camera_info':
                info = message
            elif topic == '/tf_static':
                transforms += message.transforms
    return images, info, transforms


class Camera:
    """Publishes the images at their rate, stamped with the present, and hears the estimates."""

    def __init__(self, info, transforms):
        self.images = rospy.Publisher('/camera/image_raw', Image, queue_size=10)
        self.infos = rospy.Publisher('/camera/camera_info', CameraInfo, queue_size=10, latch=True)
        self.poses = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.info = info
        for transform in transforms:
            transform.header.stamp = rospy.Time.now()
        self.poses.publish(TFMessage(transforms))
        self.infos.publish(info)
        self.sent, self.heard, self.diagnostics, self.ready = {}, {}, {}, threading.Event()
        self.subscribers = [
            rospy.Subscriber('/stiffness', StiffnessEstimate, self.on_estimate, queue_size=100, tcp_nodelay=True),
            rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_diagnostics, queue_size=10)]

    def on_estimate(self, message):
        self.heard.setdefault(message.header.stamp.to_nsec(), time.perf_counter())

    def on_diagnostics(self, message):
        for status in message.status:
            self.diagnostics[status.name.split(': ')[-1]] = {entry.key: entry.value for entry in status.values}

    def wait_for_listeners(self):
        deadline = time.time() + 60
        while self.images.get_num_connections() == 0 or self.infos.get_num_connections() == 0:
            if time.time() > deadline:
                raise SystemExit('measure_latency: nobody listens to the images')
            time.sleep(0.1)
        time.sleep(3.0)  # all of them

    def film(self, images):
        start, first = time.perf_counter(), rospy.Time.now()
        for k, image in enumerate(images):
            wait = start + k / RATE - time.perf_counter()
            if wait > 0.0:
                time.sleep(wait)
            image.header.stamp = first + rospy.Duration(k / RATE)
            self.info.header.stamp = image.header.stamp
            self.infos.publish(self.info)
            self.sent[image.header.stamp.to_nsec()] = time.perf_counter()
            self.images.publish(image)
        time.sleep(2.0)

    def close(self):
        for end in self.subscribers + [self.images, self.infos, self.poses]:
            end.unregister()

    def latencies(self):
        stamps = sorted(self.sent)[WARM:]
        return sorted(1e3 * (self.heard[stamp] - self.sent[stamp]) for stamp in stamps if stamp in self.heard), len(stamps)


def measure(model, recording, nodelets):
    images, info, transforms = recording
    camera = Camera(info, transforms)
    launch = subprocess.Popen(['roslaunch', 'tissue_stiffness', 'camera.launch', 'model:=' + model,
                               'nodelets:=' + ('true' if nodelets else 'false')], stdout=subprocess.DEVNULL)
    try:
        camera.wait_for_listeners()
        camera.film(images)
    finally:
        launch.terminate()
        launch.wait(timeout=30)
        camera.close()
    times, count = camera.latencies()
    if not times:
        raise SystemExit('measure_latency: no estimate came')
    stages = {**camera.diagnostics.get('segmentation', {}), **camera.diagnostics.get('estimator', {})}

    def mean(stage):
        text = stages.get(stage + ' [ms]', '')
        return text.split()[0] if text else '-'
    return ['nodelets' if nodelets else 'nodes', f'{times[len(times) // 2]:.1f}', f'{times[int(0.99 * (len(times) - 1))]:.1f}',
            f'{len(times)} of {count}', stages.get('frames dropped', '-')] + [
                mean(stage) for stage in ('segment', 'predict', 'observe', 'update', 'reprocess')]


def main():
    parser = argparse.ArgumentParser(prog='measure_latency')
    parser.add_argument('root')
    parser.add_argument('--seconds', type=float, default=20.0, help='of images; 20')
    parser.add_argument('--output', help='the page whose table is written; doc/performance.md')
    arguments = parser.parse_args()
    rospy.init_node('measure_latency', disable_rostime=True)  # waits for the master
    with tempfile.TemporaryDirectory() as folder:
        model, bag = write_scene(folder, arguments.seconds)
        recording = read_bag(bag)
        rows = [measure(model, recording, nodelets) for nodelets in (False, True)]
    text = measure_performance.table(
        ['chain', 'median [ms]', 'p99 [ms]', 'answered', 'dropped', 'segment', 'predict', 'observe', 'update', 'reprocess'], rows)
    print(text)
    measure_performance.write(arguments.output or os.path.join(arguments.root, 'doc', 'performance.md'), {'latency': text})


if __name__ == '__main__':
    main()
