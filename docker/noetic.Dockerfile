# Ubuntu 20.04 with ROS Noetic.
# No test builds this image. scripts/test_suite_of_debian runs the same commands on Debian 11, which has about its versions.
#   docker build -f docker/noetic.Dockerfile -t tissue_stiffness:noetic .
#   docker run --rm -v "$PWD:/data" tissue_stiffness:noetic estimate /data/model.yaml /data/recording.bag --output /data/out
FROM ros:noetic-ros-base
WORKDIR /opt/tissue_stiffness
COPY scripts/environment scripts/install_dependencies scripts/
RUN scripts/install_dependencies --python && rm -rf /var/lib/apt/lists/*
COPY . .
RUN scripts/build
ENTRYPOINT ["scripts/run"]
CMD ["--help"]
