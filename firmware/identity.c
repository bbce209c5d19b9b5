#include "identity.h"

#include <avr/eeprom.h>
#include <string.h>

#include "board.h"
#include "restart.h"

static char serial[FSR_WIRE_TEXT_SIZE + 1];
static fsr_wire_identity identity;

static void read_serial(void) {
  eeprom_read_block(serial, (const void*)0, FSR_WIRE_TEXT_SIZE);
  for (uint8_t i = 0; i < FSR_WIRE_TEXT_SIZE; ++i) {
    if (serial[i] < ' ' || serial[i] > '~') serial[i] = '\0';
  }
  if (serial[0] == '\0') strcpy(serial, DEFAULT_SERIAL);
}

const fsr_wire_identity* identity_read(void) {
  read_serial();
  identity.serial = serial;
  identity.firmware = FIRMWARE_VERSION;
  identity.model = restart_reason();
  identity.rows = ROWS;
  identity.columns = COLUMNS;
  identity.full_scale = FULL_SCALE;
  identity.scan_period_us = PERIOD;
  return &identity;
}
