/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * An AVR microcontroller in a library: runs a compiled firmware in simavr, with wheels, a battery and a serial line
 * at its pins. It is linked to libsimavr, which is GPL-3, and so this file is GPL-3 too. It serves the tests alone:
 * they compile it into a temporary folder, and no part of it belongs to the installed package.
 *
 * All times are in simulated microseconds since power-on unless a name says cycles.
 */
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_adc.h>
#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>
#include <simavr/sim_regbit.h>
#include <simavr/sim_time.h>

#define PORTS 12 /* A to L */
#define BYTES 65536
#define ENCODERS 2
#define BOOT_CYCLES 80000 /* 5 ms */
#define MEGA_PCIFR 0x3B
#define MEGA_PCICR 0x68
#define MEGA_PCMSK2 0x6D

typedef struct { uint8_t byte[BYTES]; uint32_t head, tail; } queue_t;

typedef struct {
  uint64_t rose, fell;    /* cycle of the last edge of each kind */
  uint64_t high;          /* cycles spent high, up to the last fall */
  uint64_t period, width; /* of the last whole period, from rise to rise */
  uint64_t pulse;         /* width of the last pulse */
  uint32_t edges;
  uint8_t level;
} pin_t;

typedef struct { struct bed *bed; pin_t *pin; } watched_t;

typedef struct { char port; int bit; } place_t;

typedef struct {
  struct bed *bed;
  place_t a, b;
  int64_t edges, wanted; /* fed so far; where the wheel will be */
  double next, spacing;  /* cycle of the next edge; cycles between edges */
  int pending, broken;
} encoder_t;

typedef struct bed {
  avr_t *avr;
  char uart;
  avr_irq_t *rx;
  int may_send, stopped_on_zero;
  queue_t in, out;
  pin_t pins[PORTS][8];
  watched_t watched[PORTS][8];
  uint8_t driven[PORTS], driven_high[PORTS]; /* pins that are driven from outside */
  encoder_t encoders[ENCODERS];
  avr_int_vector_t port_k_change;
  uint64_t asleep;     /* cycles */
  uint64_t deaf_until; /* cycle; encoders are not heard before */
  uint16_t kept_word; /* what `bed_stall` wrote over */
  uint32_t stalled_at;
} bed_t;

static void put(queue_t *queue, uint8_t byte) {
  if (queue->head - queue->tail < BYTES) queue->byte[queue->head++ % BYTES] = byte;
}

static double cycles_of(bed_t *bed, double us) { return us * bed->avr->frequency / 1e6; }
static double us_of(bed_t *bed, uint64_t cycles) { return cycles * 1e6 / bed->avr->frequency; }

/* The serial line. simavr says when its receiver has room, so nothing is lost on the way to it; what the firmware
 * itself is too slow to take is lost as on a board. */
static void feed(bed_t *bed) {
  while (bed->may_send && bed->in.tail != bed->in.head)
    avr_raise_irq(bed->rx, bed->in.byte[bed->in.tail++ % BYTES]);
}
static void on_room(avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq, (void)value;
  ((bed_t *)param)->may_send = 1;
  feed(param);
}
static void on_full(avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq, (void)value;
  ((bed_t *)param)->may_send = 0;
}
static void on_output(avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  bed_t *bed = param;
  put(&bed->out, value);
  if (value != 0) return;
  bed->stopped_on_zero = 1;
  bed->avr->run_cycle_count = 1; /* `bed_run_to` looks after this instruction */
}

static void set_level(bed_t *bed, pin_t *pin, int level) {
  uint64_t now = bed->avr->cycle;
  if (level == pin->level) return;
  pin->level = level;
  pin->edges++;
  if (level) {
    if (pin->rose) pin->period = now - pin->rose, pin->width = pin->pulse;
    pin->rose = now;
  } else {
    pin->fell = now;
    pin->pulse = now - pin->rose;
    pin->high += pin->pulse;
  }
}
static void on_pin(avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  watched_t *watched = param;
  set_level(watched->bed, watched->pin, value & 1);
}

static avr_irq_t *pin_irq(bed_t *bed, char port, int bit) {
  return avr_io_getirq(bed->avr, AVR_IOCTL_IOPORT_GETIRQ(port), bit);
}

/* simavr 1.6 pulls inputs up again at each write to their port, each edge of a PWM among them, unless it was told of
 * an outer level. */
static void drive(bed_t *bed, char port, int bit, int level) {
  uint8_t *mask = &bed->driven[port - 'A'], *high = &bed->driven_high[port - 'A'];
  *mask |= 1 << bit;
  *high = (*high & ~(1 << bit)) | (level != 0) << bit;
  avr_ioport_external_t outer = {.name = port, .mask = *mask, .value = *high};
  avr_ioctl(bed->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL(port), &outer);
  int has_changed = bed->pins[port - 'A'][bit].level != level;
  avr_raise_irq(pin_irq(bed, port, bit), level);
  if (port == 'K' && has_changed && bed->port_k_change.vector && bed->avr->data[MEGA_PCMSK2] & 1 << bit)
    avr_raise_interrupt(bed->avr, &bed->port_k_change);
}

/* simavr 1.6 has the pin change interrupt of the ATmega2560's port B, and not that of port K. */
static void add_port_k_change(bed_t *bed) {
  bed->port_k_change = (avr_int_vector_t){
    .vector = 11, /* PCINT2 */
    .enable = AVR_IO_REGBIT(MEGA_PCICR, 2),
    .raised = AVR_IO_REGBIT(MEGA_PCIFR, 2),
  };
  avr_register_vector(bed->avr, &bed->port_k_change);
}

/* Encoders: edges at even distances until the wheel is where it is wanted. */
static void one_edge(encoder_t *encoder) {
  static const uint8_t a[4] = {1, 0, 0, 1}, b[4] = {1, 1, 0, 0};
  encoder->edges += encoder->edges < encoder->wanted ? 1 : -1;
  if (encoder->broken) return; /* a cable that came off: the wheel turns, nothing is heard of it */
  /* Nobody listens right after a reset. And simavr 1.6 takes a low pin for a level interrupt that never ends if it
   * falls before EICRA is set. */
  if (encoder->bed->avr->cycle < encoder->bed->deaf_until) return;
  drive(encoder->bed, encoder->a.port, encoder->a.bit, a[encoder->edges & 3]);
  drive(encoder->bed, encoder->b.port, encoder->b.bit, b[encoder->edges & 3]);
}
static avr_cycle_count_t on_edge(avr_t *avr, avr_cycle_count_t when, void *param) {
  (void)avr, (void)when;
  encoder_t *encoder = param;
  encoder->pending = 0;
  if (encoder->edges == encoder->wanted) return 0;
  one_edge(encoder);
  if (encoder->edges == encoder->wanted) return 0;
  encoder->pending = 1;
  encoder->next += encoder->spacing;
  return (avr_cycle_count_t)encoder->next;
}
static void start_encoder(encoder_t *encoder) {
  avr_t *avr = encoder->bed->avr;
  uint64_t now = avr->cycle;
  if (encoder->pending) avr_cycle_timer_cancel(avr, on_edge, encoder);
  encoder->pending = encoder->edges != encoder->wanted;
  if (!encoder->pending) return;
  uint64_t wait = encoder->next > now + 1 ? (uint64_t)encoder->next - now : 1;
  avr_cycle_timer_register(avr, wait, on_edge, encoder);
}

/* A processor that sleeps goes to the next event at once; simavr's own callback would wait in real time. */
static void no_wait(avr_t *avr, avr_cycle_count_t cycles) { (void)avr, (void)cycles; }

static void only_errors(avr_t *avr, const int level, const char *format, va_list words) {
  (void)avr;
  if (level <= LOG_ERROR) vfprintf(stderr, format, words);
}

static void join_uart(bed_t *bed) {
  uint32_t flags = 0, request = AVR_IOCTL_UART_GET_FLAGS(bed->uart);
  avr_ioctl(bed->avr, request, &flags);
  flags &= ~(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
  avr_ioctl(bed->avr, AVR_IOCTL_UART_SET_FLAGS(bed->uart), &flags);
  uint32_t uart = AVR_IOCTL_UART_GETIRQ(bed->uart);
  bed->rx = avr_io_getirq(bed->avr, uart, UART_IRQ_INPUT);
  bed->may_send = 1;
  avr_irq_register_notify(avr_io_getirq(bed->avr, uart, UART_IRQ_OUTPUT), on_output, bed);
  avr_irq_register_notify(avr_io_getirq(bed->avr, uart, UART_IRQ_OUT_XON), on_room, bed);
  avr_irq_register_notify(avr_io_getirq(bed->avr, uart, UART_IRQ_OUT_XOFF), on_full, bed);
}

static void watch_pins(bed_t *bed) {
  for (int port = 0; port < PORTS; port++)
    for (int bit = 0; bit < 8; bit++) {
      avr_irq_t *irq = pin_irq(bed, 'A' + port, bit);
      if (!irq) continue;
      bed->watched[port][bit] = (watched_t){bed, &bed->pins[port][bit]};
      avr_irq_register_notify(irq, on_pin, &bed->watched[port][bit]);
    }
}

/* Returns NULL for a file that is no ELF or a microcontroller that simavr does not know. */
bed_t *bed_open(const char *elf, const char *mcu, uint32_t hz, char uart) {
  elf_firmware_t firmware;
  memset(&firmware, 0, sizeof firmware);
  avr_global_logger_set(only_errors);
  if (elf_read_firmware(elf, &firmware)) return NULL;
  strcpy(firmware.mmcu, mcu);
  firmware.frequency = hz;
  bed_t *bed = calloc(1, sizeof *bed);
  bed->avr = avr_make_mcu_by_name(mcu);
  if (!bed->avr) return free(bed), NULL;
  avr_init(bed->avr);
  avr_load_firmware(bed->avr, &firmware);
  bed->avr->log = LOG_ERROR;
  bed->avr->sleep = no_wait;
  bed->avr->frequency = hz;
  bed->avr->vcc = bed->avr->avcc = bed->avr->aref = 5000;
  bed->uart = uart;
  join_uart(bed);
  watch_pins(bed);
  if (!strcmp(mcu, "atmega2560")) add_port_k_change(bed);
  /* Else simavr looks at each cycle whether a pin of INT0 or INT1 is still low, which halves its speed. */
  for (int i = 0; i < 2; i++) avr_extint_set_strict_lvl_trig(bed->avr, i, 0);
  bed->deaf_until = BOOT_CYCLES;
  return bed;
}
void bed_close(bed_t *bed) {
  avr_terminate(bed->avr);
  free(bed);
}

static avr_cycle_count_t on_end(avr_t *avr, avr_cycle_count_t when, void *param) {
  (void)avr, (void)when, (void)param;
  return 0;
}

/* Runs to a time; with `until_zero` only to the next 0x00 that comes out. Returns 0, or 1 when the processor died. */
int bed_run_to(bed_t *bed, double us, int until_zero) {
  double cycles = cycles_of(bed, us);
  uint64_t end = (uint64_t)cycles;
  if (end < cycles) end++; /* never short of the time that was asked for */
  bed->stopped_on_zero = 0;
  bed->avr->run_cycle_limit = end; /* simavr looks at its timers when one is due, not after each instruction */
  if (end > bed->avr->cycle) avr_cycle_timer_register(bed->avr, end - bed->avr->cycle, on_end, bed);
  feed(bed);
  while (bed->avr->cycle < end && !(until_zero && bed->stopped_on_zero)) {
    uint64_t before = bed->avr->cycle;
    int state = avr_run(bed->avr);
    if (state == cpu_Sleeping) bed->asleep += bed->avr->cycle - before;
    if (state == cpu_Done || state == cpu_Crashed) return 1;
  }
  return 0;
}
double bed_now_us(bed_t *bed) { return us_of(bed, bed->avr->cycle); }
double bed_asleep_us(bed_t *bed) { return us_of(bed, bed->asleep); }

void bed_send(bed_t *bed, const uint8_t *bytes, int count) {
  for (int i = 0; i < count; i++) put(&bed->in, bytes[i]);
  feed(bed);
}
int bed_unsent(bed_t *bed) { return bed->in.head - bed->in.tail; }
void bed_drop_unsent(bed_t *bed) { bed->in.tail = bed->in.head; }
int bed_receive(bed_t *bed, uint8_t *bytes, int room) {
  int count = 0;
  while (count < room && bed->out.tail != bed->out.head) bytes[count++] = bed->out.byte[bed->out.tail++ % BYTES];
  return count;
}

static pin_t *pin_at(bed_t *bed, char port, int bit) { return &bed->pins[port - 'A'][bit]; }
int bed_level(bed_t *bed, char port, int bit) { return pin_at(bed, port, bit)->level; }
uint32_t bed_edges(bed_t *bed, char port, int bit) { return pin_at(bed, port, bit)->edges; }
double bed_fell_us(bed_t *bed, char port, int bit) { return us_of(bed, pin_at(bed, port, bit)->fell); }
double bed_pulse_us(bed_t *bed, char port, int bit) { return us_of(bed, pin_at(bed, port, bit)->pulse); }
double bed_high_us(bed_t *bed, char port, int bit) {
  pin_t *pin = pin_at(bed, port, bit);
  return us_of(bed, pin->high + (pin->level ? bed->avr->cycle - pin->rose : 0));
}
/* Share of the last whole period; a pin that has not changed for 20 ms counts as constant. */
double bed_duty(bed_t *bed, char port, int bit) {
  pin_t *pin = pin_at(bed, port, bit);
  uint64_t last = pin->rose > pin->fell ? pin->rose : pin->fell;
  if (!pin->period || bed->avr->cycle - last > bed->avr->frequency / 50) return pin->level;
  return (double)pin->width / pin->period;
}
void bed_drive_pin(bed_t *bed, char port, int bit, int level) { drive(bed, port, bit, level); }
void bed_adc(bed_t *bed, int channel, uint32_t millivolts) {
  avr_raise_irq(avr_io_getirq(bed->avr, AVR_IOCTL_ADC_GETIRQ, channel), millivolts);
}
int bed_memory(bed_t *bed, uint32_t address) {
  return address <= bed->avr->ramend ? bed->avr->data[address] : -1;
}
void bed_write(bed_t *bed, uint32_t address, uint8_t value) {
  if (address <= bed->avr->ramend) bed->avr->data[address] = value;
}

void bed_encoder(bed_t *bed, int index, char port_a, int bit_a, char port_b, int bit_b) {
  encoder_t *encoder = &bed->encoders[index];
  encoder->bed = bed;
  encoder->a = (place_t){port_a, bit_a};
  encoder->b = (place_t){port_b, bit_b};
  drive(bed, port_a, bit_a, 1); /* both pulled up */
  drive(bed, port_b, bit_b, 1);
}
/* The wheel will have turned by `edges` in all, after `us` from now. */
void bed_encoder_to(bed_t *bed, int index, int64_t edges, double us) {
  encoder_t *encoder = &bed->encoders[index];
  int64_t missing = llabs(edges - encoder->edges);
  encoder->wanted = edges;
  if (missing) encoder->spacing = cycles_of(bed, us) / missing;
  encoder->next = bed->avr->cycle + encoder->spacing / 2;
  start_encoder(encoder);
}
int64_t bed_encoder_edges(bed_t *bed, int index) { return bed->encoders[index].edges; }
void bed_encoder_broken(bed_t *bed, int index, int broken) { bed->encoders[index].broken = broken; }

/* Reset causes as bits of MCUSR: 1 power-on, 2 external, 4 brown-out, 8 watchdog. */
void bed_reset(bed_t *bed, int cause) {
  avr_t *avr = bed->avr;
  avr_reset(avr);
  avr_regbit_setto(avr, avr->reset_flags.porf, cause & 1);
  avr_regbit_setto(avr, avr->reset_flags.extrf, cause >> 1 & 1);
  avr_regbit_setto(avr, avr->reset_flags.borf, cause >> 2 & 1);
  avr_regbit_setto(avr, avr->reset_flags.wdrf, cause >> 3 & 1);
  for (int port = 0; port < PORTS; port++) /* in reset all pins float, and the pull-downs win */
    for (int bit = 0; bit < 8; bit++) set_level(bed, &bed->pins[port][bit], 0);
  bed->in.tail = bed->in.head;
  bed->may_send = 1;
  bed->deaf_until = avr->cycle + BOOT_CYCLES;
  for (int i = 0; i < ENCODERS; i++) bed->encoders[i].pending = 0; /* avr_reset forgot the timers */
}

/* The processor runs into an endless loop; `bed_unstall` gives it back its program. Interrupts go on: with them off,
 * simavr 1.6 would wait for ever with the watchdog's own, where the real one resets after the next time-out. */
void bed_stall(bed_t *bed) {
  avr_t *avr = bed->avr;
  bed->stalled_at = avr->pc;
  memcpy(&bed->kept_word, avr->flash + avr->pc, 2);
  avr->flash[avr->pc] = 0xFF, avr->flash[avr->pc + 1] = 0xCF; /* rjmp . */
}
void bed_unstall(bed_t *bed) { memcpy(bed->avr->flash + bed->stalled_at, &bed->kept_word, 2); }
