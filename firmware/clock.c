#include "clock.h"

#include <avr/interrupt.h>
#include <avr/io.h>

static volatile uint32_t turns; /* of the 16-bit timer */

ISR(TIMER1_OVF_vect) {
  ++turns;
}

void clock_start(void) {
  TCCR1A = 0;
  TCCR1B = (1 << CS11); /* 16 MHz / 8 */
  TIMSK1 |= (1 << TOIE1);
}

uint32_t clock_us(void) {
  uint16_t ticks = TCNT1;
  uint32_t whole = turns;
  /* The timer turned over, but its interrupt has not run yet. */
  if ((TIFR1 & (1 << TOV1)) != 0 && ticks < 0x8000u) ++whole;
  return (whole << 15) + ticks / TICKS_PER_US;
}
