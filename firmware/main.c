/* Reference firmware for an Arduino Mega 2560 (ATmega2560 at 16 MHz): reads a matrix, a pressure transducer and
 * a thermometer, and sends the packets of docs/wire_format.md. docs/firmware.md explains it. */

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <util/atomic.h>

#include "board.h"
#include "clock.h"
#include "identity.h"
#include "restart.h"
#include "scan.h"
#include "trigger.h"
#include "uart.h"

#define SECOND_US 1000000u
#define LED (1 << PB7) /* the board's own, pin 13 */

static uint8_t packet[LARGEST_PACKET];
static bool dropped; /* a packet, since the last identity */

static void send(size_t size) {
  if (!uart_send(packet, size)) dropped = true;
}

static uint32_t now(void) {
  uint32_t time = 0;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    time = clock_us();
  }
  return time;
}

/* What is still needed of a frame after it was released. */
typedef struct {
  uint32_t number;
  uint32_t time_us;
  uint16_t transducer;
  uint16_t thermometer;
} reference;

/* Releases the frame as soon as its counts are in the packet, so that the converter can go on. */
static reference send_scan(const scan_frame* frame) {
  const reference kept = {frame->number, frame->transducer_us, frame->transducer, frame->thermometer};
  const uint32_t duration = frame->last_us - frame->first_us;
  const fsr_wire_scan scan = {ROWS, COLUMNS, FULL_SCALE, duration, frame->counts};
  const size_t size = fsr_wire_encode_scan(packet, sizeof packet, frame->number, frame->first_us + duration / 2, &scan);
  scan_release();
  send(size);
  return kept;
}

static void send_transducer(const reference* reading) {
  send(fsr_wire_encode_transducer(packet, sizeof packet, reading->number, reading->time_us, reading->transducer));
}

/* The LED tells whether packets were dropped in the last second. */
static void send_identity(const fsr_wire_identity* identity, uint32_t sequence) {
  PORTB = dropped ? LED : 0;
  dropped = false;
  send(fsr_wire_encode_identity(packet, sizeof packet, sequence, now(), identity));
}

/* The thermometer's codes since the last temperature. */
static struct {
  uint32_t sum, samples, first_us;
} warmth;

static void add_warmth(const reference* reading) {
  if (warmth.samples++ == 0) warmth.first_us = reading->time_us;
  warmth.sum += reading->thermometer;
}

static int32_t millidegrees(void) {
  const uint32_t sixteenths = warmth.sum * 16 / warmth.samples; /* of a code */
  const uint32_t microvolts = sixteenths * (SUPPLY_MV * 1000 / 16) / FULL_SCALE;
  return ((int32_t)microvolts - THERMOMETER_ZERO_MV * 1000) / THERMOMETER_MV_PER_KELVIN;
}

/* The mean of a second, with the stamp of its middle. */
static void send_temperature(const reference* reading, uint32_t sequence) {
  const uint32_t middle_us = warmth.first_us + (reading->time_us - warmth.first_us) / 2;
  send(fsr_wire_encode_temperature(packet, sizeof packet, sequence, middle_us, millidegrees()));
  warmth.sum = warmth.samples = 0;
}

static void send_trigger(void) {
  trigger_edge edge;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    edge = trigger_take();
  }
  send(fsr_wire_encode_trigger(packet, sizeof packet, edge.number, edge.time_us, edge.high, edge.deviation_us));
}

/* Sleeps until an interrupt, unless a frame is ready already, and sends edges of the trigger meanwhile. */
static const scan_frame* next_frame(void) {
  for (;;) {
    while (trigger_waiting > 0) send_trigger();
    const scan_frame* frame = scan_take();
    if (frame != NULL) {
      sei();
      return frame;
    }
    sleep_enable();
    sei();
    sleep_cpu();
    sleep_disable();
  }
}

int main(void) {
  const fsr_wire_identity* identity = identity_read();
  uint32_t sequence = 0; /* of identity and temperature */
  uint32_t second = 0;
  DDRB = LED;
  uart_start();
  clock_start();
  trigger_start();
  scan_start();
  restart_watch();
  sei();
  send_identity(identity, sequence);
  for (;;) {
    const reference reading = send_scan(next_frame());
    restart_postpone(); /* only scans do: a converter that stands still is a fault, too */
    send_transducer(&reading);
    add_warmth(&reading);
    if (reading.time_us - second >= SECOND_US) {
      second += SECOND_US;
      send_temperature(&reading, sequence);
      send_identity(identity, ++sequence);
    }
  }
}
