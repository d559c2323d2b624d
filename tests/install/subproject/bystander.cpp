static_assert(__cplusplus == 201703L, "the standard of the project around Apsis");
#ifdef NDEBUG
#error "compiled in Release mode, which the enclosing project did not request"
#endif
#ifdef __STRICT_ANSI__
#error "compiled without the extensions that the enclosing project requested"
#endif

int bystander(int unused) {
  return 0;
}
