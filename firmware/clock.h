#pragma once

#include <stdint.h>

/* Timer 1 counts half microseconds without end. It is never set, so the stamps run evenly. */
#define TICKS_PER_US 2u

void clock_start(void);

/* The board's clock [us], wraps after 71.6 minutes. Call it with interrupts off. */
uint32_t clock_us(void);
