#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void uart_start(void);

/* Queues a whole packet. Where the ring buffer has no room for all of it, none of it is sent, and the result
 * is false: a receiver then sees a gap in the sequence, but never half a packet. */
bool uart_send(const uint8_t* packet, size_t size);
