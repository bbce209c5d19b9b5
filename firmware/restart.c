#include "restart.h"

#include <avr/io.h>
#include <avr/wdt.h>
#include <stdint.h>

static uint8_t reason __attribute__((section(".noinit")));

/* Runs before main(): after a watchdog reset the watchdog is still on, with its shortest time. */
void keep_reason(void) __attribute__((naked, used, section(".init3")));
void keep_reason(void) {
  reason = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

const char* restart_reason(void) {
  /* A supply that rises slowly sets the brown-out flag as well. */
  if ((reason & (1 << PORF)) != 0) return "mega power-on";
  if ((reason & (1 << BORF)) != 0) return "mega brown-out";
  if ((reason & (1 << WDRF)) != 0) return "mega watchdog";
  if ((reason & (1 << EXTRF)) != 0) return "mega reset pin";
  return "mega2560";
}

void restart_watch(void) {
  wdt_enable(WDTO_1S);
}

void restart_postpone(void) {
  wdt_reset();
}
