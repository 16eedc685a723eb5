/* Serves a force-feedback device to hapticd: the messages, and a client of them in C99 that needs nothing but
 * this file. For programs that have the closed library of a device's maker; spring_example.c beside it is one
 * without hardware.
 *
 *     program  -- haptic_sample, 1 kHz -->  hapticd      a local SEQPACKET socket: device { external { path }
 * }
 *              <-- haptic_force, for each --
 *
 *     struct haptic_device device;
 *     if (haptic_device_open(&device, "/run/hapticd/omega.sock") != 0) ...
 *     for (each millisecond) {
 *       ... fill sample from the maker's library, sample.time_ns = haptic_device_now();
 *       int error = haptic_device_exchange(&device, &sample, 0);
 *       haptic_device_force(&device, force, torque);      // zero if none came within 3 ms, or error is not 0
 *       ... give force to the maker's library
 *     }
 *     haptic_device_close(&device);
 *
 * SI units, right-handed world frame. A device that has no orientation sends 1, 0, 0, 0. Little-endian. */
#pragma once

#include <errno.h>
#include <poll.h>
#include <stdint.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "these messages are little-endian, and this machine is not"
#endif

#define HAPTIC_DEVICE_MAGIC 0x44504148U /* "HAPD" */
#define HAPTIC_DEVICE_VERSION 1U

/* NOLINTBEGIN(readability-identifier-naming): names as C has them */
enum haptic_message_kind { HAPTIC_SAMPLE = 1, HAPTIC_FORCE = 2, HAPTIC_REFUSED = 3 };

/* Why hapticd ended the connection. */
enum haptic_refusal {
  HAPTIC_NOT_REFUSED = 0,
  HAPTIC_MALFORMED = 1,     /* wrong size, magic, kind, a sequence or a time that does not ascend, ... */
  HAPTIC_OTHER_VERSION = 2, /* `version` is that of hapticd */
  HAPTIC_BUSY = 3,          /* another program serves this device */
  HAPTIC_NOT_PERMITTED = 4, /* this user may not: device.external.user in the config */
  HAPTIC_SILENT = 5,        /* no sample for a second */
  HAPTIC_STOPPED = 6        /* hapticd stops */
};

/* What the device measured: 112 bytes. */
struct haptic_sample {
  uint32_t magic;
  uint16_t version;
  uint16_t kind;         /* HAPTIC_SAMPLE */
  uint64_t sequence;     /* from 1, ascends */
  int64_t time_ns;       /* CLOCK_MONOTONIC when it was measured; ascends, not in future */
  double position[3];    /* of the device's origin, m */
  double orientation[4]; /* world_from_device: unit quaternion w, x, y, z */
  double velocity[3];    /* m/s */
  uint32_t buttons;      /* bit n: button n is down */
  uint32_t reserved;     /* 0 */
};

/* What it shall do to its user: 80 bytes. */
struct haptic_force {
  uint32_t magic;
  uint16_t version;
  uint16_t kind;      /* HAPTIC_FORCE, or HAPTIC_REFUSED, after which the connection ends */
  uint64_t sequence;  /* of the sample that is answered */
  int64_t expires_ns; /* CLOCK_MONOTONIC, from when on force and torque are zero */
  double force[3];    /* N, on the user */
  double torque[3];   /* N m, on the user, about the device's origin */
  uint32_t refusal;   /* enum haptic_refusal */
  uint32_t reserved;  /* 0 */
};

struct haptic_device {
  int socket; /* -1: not connected */
  uint64_t sequence;
  struct haptic_force newest;
};

/* Nanoseconds of CLOCK_MONOTONIC. */
static inline int64_t haptic_device_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* Forgets the force, and ends the connection if there is one. */
static inline void haptic_device_close(struct haptic_device* device) {
  if (device->socket >= 0) close(device->socket);
  device->socket = -1;
  memset(device->newest.force, 0, sizeof(device->newest.force));
  memset(device->newest.torque, 0, sizeof(device->newest.torque));
}

/* 0, or a negative errno. */
static inline int haptic_device_open(struct haptic_device* device, const char* path) {
  struct sockaddr_un name;
  memset(device, 0, sizeof(*device));
  memset(&name, 0, sizeof(name));
  device->socket = -1;
  name.sun_family = AF_UNIX;
  if (strlen(path) >= sizeof(name.sun_path)) return -ENAMETOOLONG;
  memcpy(name.sun_path, path, strlen(path));
  device->socket = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (device->socket < 0) return -errno;
  if (connect(device->socket, (const struct sockaddr*)&name, sizeof(name)) == 0) return 0;
  const int error = errno;
  haptic_device_close(device);
  return -error;
}

/* Sends the sample, whose first four fields are filled in here, and takes the forces that have come, waiting
 * for the first one up to `wait_ms`. 0, or a negative errno: -EPROTO if hapticd refused
 * (device->newest.refusal tells why) or does not speak as told above. After an error the connection is
 * closed. */
static inline int haptic_device_exchange(struct haptic_device* device, struct haptic_sample* sample,
                                         int wait_ms) {
  if (device->socket < 0) return -ENOTCONN;
  sample->magic = HAPTIC_DEVICE_MAGIC;
  sample->version = HAPTIC_DEVICE_VERSION;
  sample->kind = HAPTIC_SAMPLE;
  sample->sequence = ++device->sequence;
  sample->reserved = 0;
  int error = 0;
  /* a daemon that does not read for a while is no reason to end: its forces expire. One that has refused may
   * have closed the connection already, and what it said is still to be read */
  if (send(device->socket, sample, sizeof(*sample), MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno != EAGAIN)
    error = -errno;
  struct pollfd readable = {device->socket, POLLIN, 0};
  if (wait_ms > 0) (void)poll(&readable, 1, wait_ms);
  for (;;) {
    struct haptic_force force;
    const ssize_t size = recv(device->socket, &force, sizeof(force), MSG_DONTWAIT | MSG_TRUNC);
    if (size < 0 && errno == EAGAIN) break;
    if (size < 0 && errno == ECONNRESET && error != -ECONNRESET) { /* what was said before comes after it */
      error = -ECONNRESET;
      continue;
    }
    if (size <= 0) {
      if (error == 0) error = size < 0 ? -errno : -ECONNRESET;
      break;
    }
    if (size != (ssize_t)sizeof(force) || force.magic != HAPTIC_DEVICE_MAGIC ||
        (force.kind != HAPTIC_REFUSED && force.version != HAPTIC_DEVICE_VERSION)) {
      error = -EPROTO;
      break;
    }
    device->newest = force;
    if (force.kind == HAPTIC_FORCE) continue;
    error = -EPROTO;
    break;
  }
  if (error != 0) haptic_device_close(device);
  return error;
}

/* What the device shall do now (N; N m): zero if nothing came in time. */
static inline void haptic_device_force(const struct haptic_device* device, double force[3],
                                       double torque[3]) {
  const int live = device->newest.kind == HAPTIC_FORCE && haptic_device_now() < device->newest.expires_ns;
  for (int i = 0; i < 3; ++i) {
    force[i] = live ? device->newest.force[i] : 0.0;
    torque[i] = live ? device->newest.torque[i] : 0.0;
  }
}
/* NOLINTEND(readability-identifier-naming) */
