#include "trigger.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/delay.h>

#include "clock.h"

#define INPUT (1 << PL0)
#define DEBOUNCE_TICKS ((uint16_t)(DEBOUNCE_US * TICKS_PER_US))
/* Two clocks of half microseconds, read one after the other. */
#define EXACT_US 2u
#define MOST_WAITING 8u /* a power of two */

volatile uint8_t trigger_waiting;
static trigger_edge edges[MOST_WAITING];
static uint8_t first; /* of those that wait */
static uint32_t number;
static bool high;

static bool level(void) {
  return (PINL & INPUT) != 0;
}

/* Waits for the edge away from the present level. */
static void arm(void) {
  TCCR4B = (uint8_t)((1 << ICNC4) | (high ? 0 : 1 << ICES4) | (1 << CS41)); /* 16 MHz / 8 */
  TIFR4 = (1 << ICF4);
  TIMSK4 = (1 << ICIE4);
}

/* Notes an edge `ago` ticks before now, and leaves the pin alone for DEBOUNCE_US. */
static void note(uint16_t ago, uint32_t deviation_us) {
  const uint32_t now = clock_us();
  high = !high;
  if (trigger_waiting < MOST_WAITING) {
    edges[(uint8_t)(first + trigger_waiting++) & (MOST_WAITING - 1)] = (trigger_edge){number, now - ago / TICKS_PER_US, deviation_us, high};
  }
  ++number;
  OCR4A = (uint16_t)(TCNT4 + DEBOUNCE_TICKS);
  TIFR4 = (1 << OCF4A);
  TIMSK4 = (1 << OCIE4A);
}

ISR(TIMER4_CAPT_vect) {
  note((uint16_t)(TCNT4 - ICR4), EXACT_US);
}

ISR(TIMER4_COMPA_vect) {
  arm();
  if (level() == high || (TIFR4 & (1 << ICF4)) != 0) return;
  note(DEBOUNCE_TICKS / 2, DEBOUNCE_US / 2); /* it went back while nobody looked */
}

void trigger_start(void) {
  DDRG = TRIGGER_OUT;
  PORTL = INPUT; /* pull-up */
  TCCR4A = 0;
  _delay_us(200);
  high = level();
  arm();
}

trigger_edge trigger_take(void) {
  const trigger_edge edge = edges[first];
  first = (uint8_t)(first + 1) & (MOST_WAITING - 1);
  --trigger_waiting;
  return edge;
}
