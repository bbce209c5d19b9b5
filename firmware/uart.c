#include "uart.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#include "board.h"

static uint8_t ring[RING];
static uint16_t head;          /* where the next byte is written */
static volatile uint16_t tail; /* where the next byte is sent from */

ISR(USART0_UDRE_vect) {
  UDR0 = ring[tail];
  const uint16_t next = (uint16_t)((tail + 1) & (RING - 1));
  tail = next;
  if (next == head) UCSR0B &= (uint8_t)~(1 << UDRIE0);
}

void uart_start(void) {
  UCSR0A = (1 << U2X0); /* twice the speed: the clock divided by 8, not 16 */
  UBRR0 = (uint16_t)UBRR_VALUE;
  UCSR0C = (1 << UCSZ01) | (1 << UCSZ00); /* 8N1 */
  UCSR0B = (1 << TXEN0);
}

bool uart_send(const uint8_t* packet, size_t size) {
  uint16_t at = head;
  uint16_t used = 0;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    used = (uint16_t)((head - tail) & (RING - 1));
  }
  if (size > (size_t)(RING - 1 - used)) return false; /* one byte stays free: a full ring is not an empty one */
  for (size_t i = 0; i < size; ++i) {
    ring[at] = packet[i];
    at = (uint16_t)((at + 1) & (RING - 1));
  }
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    head = at;
    UCSR0B |= (1 << UDRIE0);
  }
  return true;
}
