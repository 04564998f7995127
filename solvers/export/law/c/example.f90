! The law from Fortran: make example-f90.
program example
  use, intrinsic :: iso_c_binding
  use @NAME@
  implicit none
  type(law_material) :: material
  type(law_impact) :: impact
  type(law_collision) :: found
  integer(c_int) :: status
  integer :: k

  material = law_default_material()
  do k = 0, 8
    impact%speed = @SPEED@_c_double*10.0_c_double**(k/4.0_c_double - 1)
    impact%angle = 1
    impact%spin = 0
    impact%partner_spin = 0
    status = law_collide(material, impact, 1.0e-9_c_double, 0_c_int, found)
    if (status == LAW_OK) then
      print '(es12.4, i4, f14.9)', impact%speed, found%outcome, found%restitution
    else
      print '(es12.4, 2x, a)', impact%speed, law_message(status)
    end if
  end do
end program example
