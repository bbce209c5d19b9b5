#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "board.h"

/* What one turn of the converter has read. */
typedef struct {
  uint32_t number;         /* of the scan since the start; skipped ones count too */
  uint32_t first_us;       /* clock at the sample of the first taxel */
  uint32_t last_us;        /* clock at the sample of the last one */
  uint32_t transducer_us;  /* clock in the middle of the transducer's samples */
  uint16_t transducer;     /* sum of SAMPLES codes, 0 to 16368 */
  uint16_t thermometer;    /* one code */
  uint16_t counts[TAXELS]; /* row-major */
} scan_frame;

/* Starts a scan every PERIOD from now on. Everything runs in interrupts. */
void scan_start(void);

/* A complete frame, or NULL. It stays valid until scan_release(). While it is held, the next scan is read into
 * a second frame. A frame that is complete while this one is still held is dropped; its number is missing. */
const scan_frame* scan_take(void);
void scan_release(void);
