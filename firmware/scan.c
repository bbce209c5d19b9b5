#include "scan.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <stddef.h>

#include "clock.h"
#include "trigger.h"

/* The timer compares 16 bits (32.8 ms). A longer period is waited for in SLICES equal parts and a rest. */
#define PERIOD_TICKS ((uint32_t)PERIOD * TICKS_PER_US)
#define SLICES ((PERIOD_TICKS + 0xFFFFu) / 0x10000u)
#define SLICE_TICKS ((uint16_t)(PERIOD_TICKS / SLICES))
#define LAST_SLICE_TICKS ((uint16_t)(PERIOD_TICKS - (SLICES - 1) * SLICE_TICKS))
/* At least 2 us, so that the timer does not pass the mark before it is set. */
#define SETTLING_TICKS ((uint16_t)((SETTLING_US < 2 ? 2 : SETTLING_US) * TICKS_PER_US))

/* The converter holds its input 1.5 of its clocks after a conversion starts. */
#define HOLD_US ((3u * ADC_PRESCALER / 2u + 8u) / (F_CPU / 1000000u))

#if ADC_PRESCALER == 16
#define ADC_PRESCALER_BITS ((1 << ADPS2))
#elif ADC_PRESCALER == 32
#define ADC_PRESCALER_BITS ((1 << ADPS2) | (1 << ADPS0))
#elif ADC_PRESCALER == 64
#define ADC_PRESCALER_BITS ((1 << ADPS2) | (1 << ADPS1))
#else
#define ADC_PRESCALER_BITS ((1 << ADPS2) | (1 << ADPS1) | (1 << ADPS0))
#endif

enum phase { IDLE, MATRIX, TRANSDUCER, THERMOMETER };

static scan_frame frames[2];
static volatile uint8_t ready = 2; /* index of the complete frame; 2 = none */
static scan_frame* frame = &frames[0];
static uint8_t filling;
static volatile uint8_t phase;
static uint8_t row, column, samples;
static uint16_t* next_count;
static uint32_t number;
static uint8_t slices_left;
static uint8_t until_pulse; /* scans until the next one with a pulse at the output */

static void drive_row(uint8_t selected) {
  uint8_t a = 0, c = 0;
  if (selected < 8) {
    a = (uint8_t)(1u << selected);
  } else if (selected < 16) {
    c = (uint8_t)(0x80u >> (selected - 8));
  }
  PORTA = a;
  PORTC = c;
}

static void drive_none(void) {
  drive_row(MOST_ROWS);
}

static void select_input(uint8_t input) {
  ADMUX = (uint8_t)((1 << REFS0) | (input & 7)); /* reference = supply */
  ADCSRB = input >= 8 ? (1 << MUX5) : 0;
}

static void start_conversion(void) {
  ADCSRA |= (1 << ADSC);
}

static void begin_row(void) {
  drive_row(row);
  column = 0;
  select_input(0);
  OCR3A = (uint16_t)(TCNT3 + SETTLING_TICKS);
  TIFR3 = (1 << OCF3A);
  TIMSK3 = (1 << OCIE3A);
}

ISR(TIMER3_COMPA_vect) { /* the row has settled */
  TIMSK3 = 0;
  start_conversion();
  if (row != 0) return;
  frame->first_us = clock_us() + HOLD_US;
  if (until_pulse == TRIGGER_OUT_EVERY - 1) TRIGGER_OUT_PORT |= TRIGGER_OUT;
}

static void begin_scan(void) {
  const uint32_t this_one = number++;
  if (until_pulse-- == 0) until_pulse = TRIGGER_OUT_EVERY - 1;
  if (phase != IDLE) return; /* PERIOD is too short for the converter */
  frame->number = this_one;
  next_count = frame->counts;
  phase = MATRIX;
  row = 0;
  begin_row();
}

ISR(TIMER1_COMPA_vect) {
  if (--slices_left > 0) {
    OCR1A = (uint16_t)(OCR1A + (slices_left == 1 ? LAST_SLICE_TICKS : SLICE_TICKS));
    return;
  }
  slices_left = SLICES;
  OCR1A = (uint16_t)(OCR1A + (SLICES == 1 ? LAST_SLICE_TICKS : SLICE_TICKS));
  begin_scan();
}

static void begin_reference(uint8_t input, uint8_t next_phase) {
  phase = next_phase;
  select_input(input);
  start_conversion();
}

/* A frame is handed over only if the one before has been released; otherwise it is filled again. */
static void hand_over(void) {
  phase = IDLE;
  if (ready != 2) return;
  ready = filling;
  filling ^= 1;
  frame = &frames[filling];
}

/* The last taxel is being read. */
static void end_matrix(uint8_t hold_us) {
  frame->last_us = clock_us() + hold_us;
  TRIGGER_OUT_PORT &= (uint8_t)~TRIGGER_OUT;
}

static void read_taxel(uint16_t code) {
  *next_count++ = code;
  if (++column < COLUMNS) {
    select_input(column);
    start_conversion();
    if (column == COLUMNS - 1 && row == ROWS - 1) end_matrix(HOLD_US);
  } else if (++row < ROWS) {
    begin_row();
  } else {
#if COLUMNS == 1
    end_matrix(0);
#endif
    drive_none();
    frame->transducer = 0;
    samples = 0;
    begin_reference(TRANSDUCER_INPUT, TRANSDUCER);
  }
}

static void read_transducer(uint16_t code) {
  frame->transducer = (uint16_t)(frame->transducer + code);
  if (++samples == SAMPLES / 2) frame->transducer_us = clock_us();
  if (samples < SAMPLES) {
    start_conversion();
  } else {
    begin_reference(THERMOMETER_INPUT, THERMOMETER);
  }
}

ISR(ADC_vect) {
  const uint16_t code = ADC;
  if (phase == MATRIX) {
    read_taxel(code);
  } else if (phase == TRANSDUCER) {
    read_transducer(code);
  } else if (phase == THERMOMETER) {
    frame->thermometer = code;
    hand_over();
  }
}

void scan_start(void) {
  drive_none();
  DDRA = 0xFF;
  DDRC = 0xFF;
  DIDR0 = DIDR2 = 0xFF; /* no digital inputs on analogue pins */
  ADCSRA = (1 << ADEN) | (1 << ADIE) | ADC_PRESCALER_BITS;
  TCCR3B = (1 << CS31); /* as fast as the clock, but apart from it: its flags are cleared here */
  slices_left = 1;
  OCR1A = (uint16_t)(TCNT1 + LAST_SLICE_TICKS);
  TIFR1 = (1 << OCF1A);
  TIMSK1 |= (1 << OCIE1A);
}

const scan_frame* scan_take(void) {
  return ready == 2 ? NULL : &frames[ready];
}

void scan_release(void) {
  ready = 2;
}
