#pragma once

/* What the Makefile sets, the pins of an Arduino Mega 2560, and the memory that they take. check_limits
 * checks the same limits before make compiles, in sentences with numbers. The checks here are for builds
 * without that Makefile. */

#include <stdint.h>

#include "wire.h"

#if !defined(ROWS) || !defined(COLUMNS) || !defined(BAUD) || !defined(PERIOD) || !defined(SETTLING_US) || \
    !defined(ADC_PRESCALER) || !defined(RING) || !defined(F_CPU)
#error "ROWS, COLUMNS, BAUD, PERIOD, SETTLING_US, ADC_PRESCALER, RING and F_CPU must be set; see the Makefile"
#endif

#define FIRMWARE_VERSION "1.1.0"

/* Rows are driven high one after another, all others are low: row 0 to 7 = PA0 to PA7 (pins 22 to 29), row 8
 * to 15 = PC7 to PC0 (pins 30 to 37). Columns are read by ADC0 to ADC13 (pins A0 to A13). */
#define MOST_ROWS 16
#define MOST_COLUMNS 14
#define TRANSDUCER_INPUT 14  /* A14 */
#define THERMOMETER_INPUT 15 /* A15 */
#define FULL_SCALE 1023u     /* 10 bits, reference = the 5 V supply */

/* The transducer is read this many times behind each scan, and the sum is sent. */
#define SAMPLES 16
/* A TMP36: 500 mV at 0 degree Celsius, 10 mV a kelvin. */
#define THERMOMETER_ZERO_MV 500L
#define THERMOMETER_MV_PER_KELVIN 10L
#define SUPPLY_MV 5000L

#define TAXELS (ROWS * COLUMNS)
#define LARGEST_PACKET \
  (TAXELS >= 24 ? FSR_WIRE_OVERHEAD + FSR_WIRE_SCAN_PAYLOAD(ROWS, COLUMNS) \
                : FSR_WIRE_OVERHEAD + FSR_WIRE_IDENTITY_PAYLOAD)

#if ROWS < 1 || ROWS > MOST_ROWS || COLUMNS < 1 || COLUMNS > MOST_COLUMNS
#error "the board has 16 row pins and 14 column inputs: the largest matrix is 16 x 14"
#endif
#if (RING & (RING - 1)) != 0 || RING < 128 || RING > 4096
#error "RING must be a power of two from 128 to 4096 bytes: 8 KiB of RAM hold no larger one"
#endif
#if !(ADC_PRESCALER == 16 || ADC_PRESCALER == 32 || ADC_PRESCALER == 64 || ADC_PRESCALER == 128)
#error "ADC_PRESCALER must be 16, 32, 64 or 128"
#endif
#if PERIOD < 1000 || PERIOD > 500000
#error "PERIOD must be 1000 to 500000 us"
#endif

/* The UART divides the clock by 8 (UBRR + 1). More than 2.5 % off, bytes come out wrong. */
#define UBRR_VALUE ((F_CPU + 4L * BAUD) / (8L * BAUD) - 1)
#define TRUE_BAUD (F_CPU / (8L * (UBRR_VALUE + 1)))
#if TRUE_BAUD * 1000 > BAUD * 1025L || TRUE_BAUD * 1000 < BAUD * 975L
#error "this clock cannot make BAUD within 2.5 %; at 16 MHz it makes 115200, 250000, 500000 and 1000000"
#endif
