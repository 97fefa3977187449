# The image for the computers that robots have: `docker buildx bake` builds it for x86-64 and for aarch64 (Jetson,
# Raspberry Pi 5, Docker on Apple computers). What another architecture needs is emulated: `docker run --privileged --rm
# tonistiigi/binfmt --install arm64` once, or a builder on a machine of that kind (`docker buildx create --append`).
#   docker buildx bake --load --set '*.platform=linux/amd64'     one of them, for this machine's Docker
#   TIDYBOT_IMAGE=registry.example/tidybot:1.0 docker buildx bake --push     both under one name
variable "TIDYBOT_IMAGE" {
  default = "tidybot-zenoh:dev"
}

variable "BASE_IMAGE" {
  default = "python:3.11.14-slim-bookworm"
}

group "default" {
  targets = ["node"]
}

target "node" {
  context   = "."
  args      = { BASE_IMAGE = BASE_IMAGE }
  tags      = [TIDYBOT_IMAGE]
  platforms = ["linux/amd64", "linux/arm64"]
}
