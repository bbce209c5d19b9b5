#pragma once

#include <stdbool.h>
#include <stdint.h>

/* Trigger input: pin 49 (PL0 = input capture of timer 4), with its pull-up on: an open pin is high, and a switch to
 * ground makes a falling edge. An edge counts at once; then the pin is not looked at for DEBOUNCE_US, so that the
 * bounces behind it do not count. If the pin is then back, the edge in between was at an unknown time of it.
 *
 * Trigger output: pin 4 (PG5), high from the first to the last taxel of each scan whose sequence is a multiple of
 * TRIGGER_OUT_EVERY. The middle of the pulse is the stamp of the scan. */
#define DEBOUNCE_US 5000u
#define TRIGGER_OUT_EVERY 100u
#define TRIGGER_OUT_PORT PORTG
#define TRIGGER_OUT (1 << PG5)

typedef struct {
  uint32_t number;       /* of the edge since the start; dropped ones count too */
  uint32_t time_us;      /* clock at the edge */
  uint32_t deviation_us; /* the edge lies at most this far from it */
  bool high;             /* level behind it */
} trigger_edge;

void trigger_start(void);

/* Edges that were not taken yet. A read of one byte needs no lock. */
extern volatile uint8_t trigger_waiting;

/* The oldest of them. Call it with interrupts off, where there is one. */
trigger_edge trigger_take(void);
