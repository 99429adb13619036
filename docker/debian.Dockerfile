# Debian 12 with its own ROS packages.
# scripts/test_suite_of_debian runs the same commands without docker.
#   docker build -f docker/debian.Dockerfile -t tissue_stiffness .
#   docker run --rm -v "$PWD:/data" tissue_stiffness estimate /data/model.yaml /data/recording.bag --output /data/out
FROM debian:12-slim
WORKDIR /opt/tissue_stiffness
COPY scripts/environment scripts/install_dependencies scripts/
RUN scripts/install_dependencies --python && rm -rf /var/lib/apt/lists/*
COPY . .
RUN scripts/build
ENTRYPOINT ["scripts/run"]
CMD ["--help"]
