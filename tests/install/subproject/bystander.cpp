static_assert(__cplusplus == 201703L, "the standard of the project around Apsis");
#ifdef NDEBUG
#error "compiled for a release, which the project around Apsis did not ask for"
#endif
#ifdef __STRICT_ANSI__
#error "compiled without extensions, which the project around Apsis asked for"
#endif

int bystander(int unused) {
  return 0;
}
