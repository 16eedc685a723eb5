/* A device without hardware, served to hapticd from a program of its own: a mass of 0.1 kg that a hand holds
 * by a spring and moves up and down by 20 mm, once in two seconds. Where it reads and writes its own state, a
 * program for real hardware calls the library of the device's maker.
 *
 *     device { name: "left" external { path: "/tmp/left.sock" } }      in the daemon's config
 *     spring_example /tmp/left.sock 10                                 seconds; prints what it felt */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "proto/device/haptic_device.h"

enum { kPeriodNs = 1000000 };

struct hand {
  double position[3]; /* m */
  double velocity[3]; /* m/s */
};

/* One millisecond under the force (N) and the hand's spring of 300 N/m, with 6 N s/m. */
static void move(struct hand* hand, const double force[3], double time) {
  const double mass = 0.1, stiffness = 300.0, damping = 6.0, dt = kPeriodNs * 1e-9;
  const double goal[3] = {0.0, 0.02 * cos(3.14159265358979 * time), 0.0};
  for (int i = 0; i < 3; ++i) {
    const double push = force[i] + stiffness * (goal[i] - hand->position[i]) - damping * hand->velocity[i];
    hand->velocity[i] += dt * push / mass;
    hand->position[i] += dt * hand->velocity[i];
  }
}

static double length(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

int main(int argc, char** argv) {
  struct haptic_device device;
  struct hand hand = {{0.0, 0.02, 0.0}, {0.0, 0.0, 0.0}};
  double largest = 0.0;
  if (argc != 3) {
    fprintf(stderr, "usage: spring_example SOCKET SECONDS\n");
    return 64;
  }
  int error = haptic_device_open(&device, argv[1]);
  if (error != 0) {
    fprintf(stderr, "spring_example: cannot connect to %s: %s\n", argv[1], strerror(-error));
    return 5;
  }
  const long samples = (long)(atof(argv[2]) * 1e9 / kPeriodNs);
  const int64_t start = haptic_device_now();
  for (long i = 0; i < samples && error == 0; ++i) {
    struct haptic_sample sample = {.time_ns = haptic_device_now(), .orientation = {1.0, 0.0, 0.0, 0.0}};
    memcpy(sample.position, hand.position, sizeof(sample.position));
    memcpy(sample.velocity, hand.velocity, sizeof(sample.velocity));
    error = haptic_device_exchange(&device, &sample, 0);

    double force[3], torque[3];
    haptic_device_force(&device, force, torque);
    largest = fmax(largest, length(force));
    move(&hand, force, (double)i * kPeriodNs * 1e-9);

    const int64_t due = start + (i + 1) * kPeriodNs;
    const struct timespec wake = {due / 1000000000, due % 1000000000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, NULL);
  }
  if (error != 0) {
    fprintf(stderr, "spring_example: %s, refusal %u\n", strerror(-error), device.newest.refusal);
    return 1;
  }
  printf("%ld samples, %llu answered, largest force %.3f N\n", samples,
         (unsigned long long)device.newest.sequence, largest);
  haptic_device_close(&device);
  return 0;
}
