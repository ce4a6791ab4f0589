// A plugin of qemu (version 1 of its interface): how often each block of a library's instructions is executed. A line of
// the file "output" for each block: the offset of its first instruction in the library, how many instructions it has, and
// how often it was executed. Use: -plugin count_blocks.so,library=NAME,output=FILE
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Debian has no package with qemu-plugin.h. This is the part of it that is used here.
typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum { QEMU_PLUGIN_INLINE_ADD_U64 };
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb*);
struct qemu_plugin_insn* qemu_plugin_tb_get_insn(const struct qemu_plugin_tb*, size_t);
void* qemu_plugin_insn_haddr(const struct qemu_plugin_insn*);
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb*, int, void*, uint64_t);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, struct qemu_plugin_tb*));
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, void*), void*);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

struct Block {
  struct Block* next;
  uintptr_t address;
  size_t instructions;
  uint64_t executed;
};
static struct Block* blocks;
static char library[4096], output[4096];

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb* translation) {
  (void)id;
  struct Block* block = calloc(1, sizeof *block);
  if (!block) abort();
  block->address = (uintptr_t)qemu_plugin_insn_haddr(qemu_plugin_tb_get_insn(translation, 0));
  block->instructions = qemu_plugin_tb_n_insns(translation);
  block->next = blocks;
  blocks = block;
  qemu_plugin_register_vcpu_tb_exec_inline(translation, QEMU_PLUGIN_INLINE_ADD_U64, &block->executed, 1);
}

/// Writes the blocks between two addresses, of which the first one is at this offset in the library.
static void write_blocks(FILE* file, uintptr_t from, uintptr_t to, unsigned long offset) {
  for (const struct Block* block = blocks; block; block = block->next)
    if (block->executed && block->address >= from && block->address < to)
      fprintf(file, "%lu %zu %llu\n", block->address - from + offset, block->instructions,
              (unsigned long long)block->executed);
}

static void finished(qemu_plugin_id_t id, void* data) {
  (void)id, (void)data;
  FILE *maps = fopen("/proc/self/maps", "r"), *file = fopen(output, "w");
  if (!maps || !file) return;
  char line[8192];
  while (fgets(line, sizeof line, maps)) {
    unsigned long from, to, offset;
    if (strstr(line, library) && sscanf(line, "%lx-%lx %*s %lx", &from, &to, &offset) == 3)
      write_blocks(file, from, to, offset);
  }
  fclose(maps);
  fclose(file);
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const void* info, int count,
                                                               char** arguments) {
  (void)info;
  for (int i = 0; i < count; ++i) {
    sscanf(arguments[i], "library=%4095s", library);
    sscanf(arguments[i], "output=%4095s", output);
  }
  if (!*library || !*output) return fprintf(stderr, "count_blocks: needs library=NAME and output=FILE\n"), -1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, finished, NULL);
  return 0;
}
